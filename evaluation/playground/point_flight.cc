// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/playground/point_flight.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "evaluation/flight/field_map.h"
#include "evaluation/playground/scene_setup.h"
#include "evaluation/playground/scene_step.h"
#include "evaluation/record/step_json.h"
#include "touchdown/control/onboard/envelope.h"
#include "touchdown/estimation/pad/pad_predictor.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {
namespace {

using FlightReport = nlohmann::ordered_json;

constexpr double kTick = 0.002;          // the rate of Onboard's laws [s]
constexpr double kDepthRate = 10.0;      // [Hz]
constexpr double kLongestFlight = 60.0;  // [s]

control::OnboardParts PartsOf(const PlaygroundScene& scene,
                              const control::OnboardOptions& options) {
  control::OnboardParts parts = control::LandingParts(options);
  parts.planner =
      std::make_unique<planning::Replanner>(PlannerOf(scene), solvers::StandardBackends());
  return parts;
}

control::Onboard OnboardOf(const PlaygroundScene& scene) {
  const control::OnboardOptions options = OnboardOptionsOf(scene);
  return control::Onboard(options, PartsOf(scene, options));
}

sim::DepthCamera DepthCameraIn(const sim::ObstacleField& field, std::uint64_t seed) {
  return sim::DepthCamera({}, field, PlaygroundPad(), seed);
}

FlightReport PointJson(const std::vector<planning::CellIndex>& cells,
                       const planning::OccupancyMap& map) {
  FlightReport flat = FlightReport::array();
  for (const planning::CellIndex& cell : cells) {
    for (const double x : map.CentreOf(cell)) flat.push_back(std::round(1e3 * x) / 1e3);
  }
  return flat;
}

bool InOrder(const planning::CellIndex& a, const planning::CellIndex& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

std::vector<planning::CellIndex> OccupiedCells(const planning::OccupancyMap& map) {
  constexpr int kRow = 64;
  std::vector<planning::CellIndex> cells;
  const planning::CellIndex low = map.origin(), high = map.origin() + map.size();
  for (int z = low.z(); z < high.z(); ++z) {
    for (int y = low.y(); y < high.y(); ++y) {
      for (int x = low.x(); x < high.x(); x += kRow) {
        const int count = std::min(kRow, high.x() - x);
        std::uint64_t bits = map.OccupiedRow({x, y, z}, count);
        for (; bits != 0; bits &= bits - 1) {
          cells.emplace_back(x + std::countr_zero(bits), y, z);
        }
      }
    }
  }
  std::sort(cells.begin(), cells.end(), InOrder);
  return cells;
}

}  // namespace

PointFlight::PointFlight(const PlaygroundScene& scene)
    : scene_(scene),
      field_(FieldOf(scene)),
      motion_(scene.pad),
      depth_camera_(DepthCameraIn(field_, scene.seed)),
      tag_sensor_({}, field_, scene.seed),
      gps_({}, scene.seed),
      depth_clock_(kDepthRate),
      tag_clock_(sim::TagSensorConfig{}.rate_hz),
      onboard_(OnboardOf(scene)),
      vehicle_(StartOf(scene)) {
  least_clearance_ = clearance_ = HullClearance(field_, vehicle_.p_WB);
  onboard_.KeepBefore(true);
  onboard_.Take(vehicle_);
  const estimation::VehicleModel& model = onboard_.options().model;
  onboard_.Begin(0.0, estimation::Commands::Constant(
                          static_cast<Eigen::Index>(model.actuators.size()),
                          model.HoverThrust() / static_cast<double>(model.actuators.size())));
  if (scene.all_known) FillMap(field_, onboard_.mutable_map());
  Judge();
}

void PointFlight::Advance(double seconds) {
  const double until = vehicle_.t + seconds;
  while (!outcome_ && vehicle_.t < until - 0.5 * kTick) Step();
}

void PointFlight::Move(const PlaygroundScene& scene) {
  scene_.walls = scene.walls;
  scene_.pillars = scene.pillars;
  field_ = FieldOf(scene_);
  depth_camera_ = DepthCameraIn(field_, scene_.seed);
  tag_sensor_ = sim::TagSensor({}, field_, scene_.seed);
  Judge();
}

void PointFlight::Step() {
  Sense();
  const control::Setpoint setpoint = onboard_.Step(vehicle_.t);
  Note();
  MoveOn(setpoint);
  Judge();
  if (outcome_ || setpoint.armed) return;
  const estimation::PadState pad = motion_.At(vehicle_.t);
  const double off = (vehicle_.p_WB - pad.p_WP).head<2>().norm();
  outcome_ = {"landed", "It landed " + std::to_string(std::lround(1e3 * off)) +
                            " mm from the middle of the pad."};
}

void PointFlight::Sense() {
  const double t = vehicle_.t;
  const estimation::PadState pad = motion_.At(t);
  onboard_.Take(vehicle_);
  const double weight = onboard_.options().model.HoverThrust();
  onboard_.Take(estimation::FootForce{t, stands_P_ ? weight : 0.0});
  if (const auto fix = gps_.Poll(t, pad)) onboard_.Take(*fix);
  if (tag_clock_.Due(t)) {
    if (const auto sighting = tag_sensor_.Sight(t, vehicle_, pad, vehicle_.q_WB)) {
      onboard_.Take(*sighting);
    }
  }
  if (!depth_clock_.Due(t)) return;
  frame_.depth.swap(image_.depth);
  depth_camera_.Capture(vehicle_, pad, &frame_);
  frame_.depth.swap(image_.depth);
  image_.t = frame_.t;
  image_.intrinsics = frame_.intrinsics;
  image_.max_range = frame_.max_range;
  image_.p_BC = depth_camera_.config().p_BC;
  image_.R_BC = depth_camera_.R_BC();
  onboard_.Take(image_);
}

void PointFlight::Note() {
  const control::OnboardStatus& status = onboard_.status();
  if (status.mission_step && status.mission.reason != control::TransitionReason::kNone) {
    std::string text(control::ToString(status.mission.mode));
    text.append(" (").append(control::ToString(status.mission.reason)).append(")");
    events_.push_back({vehicle_.t, text});
  }
  const control::OnboardPlan& plan = onboard_.plan();
  if (plan.answer == nullptr) return;
  asked_ = *plan.asked;
  before_ = plan.before;
  answer_ = *plan.answer;
  answer_is_new_ = true;
}

// In the air exactly where the committed plan is; on the deck with the deck.
void PointFlight::MoveOn(const control::Setpoint& setpoint) {
  const double t = static_cast<double>(++steps_) * kTick;
  const estimation::PadState pad = motion_.At(t);
  const Eigen::AngleAxisd R_WP(pad.yaw, Eigen::Vector3d::UnitZ());
  vehicle_.t = t;
  if (stands_P_) {
    vehicle_.p_WB = pad.p_WP + R_WP * *stands_P_;
    vehicle_.v_WB = pad.v_WP;
    return;
  }
  if (!setpoint.armed) return;
  const planning::FlatState flat = onboard_.Reference(t);
  const planning::FlatInputs inputs = planning::InvertFlatness(flat);
  vehicle_.p_WB = flat.p_WB;
  vehicle_.v_WB = flat.v_WB;
  vehicle_.q_WB = Eigen::Quaterniond(inputs.R_WB);
  vehicle_.w_WB_B = inputs.w_WB_B;
  const Eigen::Vector3d p_PB = R_WP.inverse() * (vehicle_.p_WB - pad.p_WP);
  const double foot_depth = onboard_.options().model.foot_depth;
  const bool over_deck = p_PB.head<2>().cwiseAbs().maxCoeff() <= PlaygroundPad().deck_half_size;
  if (over_deck && p_PB.z() <= foot_depth) {
    stands_P_ = Eigen::Vector3d(p_PB.x(), p_PB.y(), foot_depth);
    vehicle_.q_WB = Eigen::AngleAxisd(flat.yaw, Eigen::Vector3d::UnitZ());
    vehicle_.w_WB_B.setZero();
    events_.push_back({t, "feet touch the deck"});
  }
}

void PointFlight::Judge() {
  clearance_ = HullClearance(field_, vehicle_.p_WB);
  least_clearance_ = std::min(least_clearance_, clearance_);
  const double foot_depth = onboard_.options().model.foot_depth;
  if (clearance_ < 0.0) {
    outcome_ = {"touched", "The hull, at some tilt, reaches an obstacle: the nearest is " +
                               std::to_string(std::lround(1e3 * -clearance_)) + " mm within it."};
  } else if (!stands_P_ && vehicle_.p_WB.z() < foot_depth) {
    outcome_ = {"touched", "The feet touch the ground beside the pad."};
  } else if (vehicle_.t >= kLongestFlight) {
    outcome_ = {"timeout", "It has not landed within 60 s."};
  }
}

nlohmann::ordered_json PointFlight::MapReport() {
  const planning::OccupancyMap& map = onboard_.map();
  std::vector<planning::CellIndex> now = OccupiedCells(map), added, removed;
  std::set_difference(now.begin(), now.end(), cells_.begin(), cells_.end(),
                      std::back_inserter(added), InOrder);
  std::set_difference(cells_.begin(), cells_.end(), now.begin(), now.end(),
                      std::back_inserter(removed), InOrder);
  cells_ = std::move(now);
  return {{"added", PointJson(added, map)}, {"removed", PointJson(removed, map)}};
}

nlohmann::ordered_json PointFlight::Report() {
  const estimation::PadState pad = motion_.At(vehicle_.t);
  const Eigen::Quaterniond& q = vehicle_.q_WB;
  FlightReport json = {{"t", vehicle_.t},
                       {"p", VectorJson(vehicle_.p_WB)},
                       {"v", VectorJson(vehicle_.v_WB)},
                       {"q", {q.w(), q.x(), q.y(), q.z()}}};
  json["pad"] = {{"p", VectorJson(pad.p_WP)}, {"yaw", pad.yaw}, {"v", VectorJson(pad.v_WP)}};
  json["mode"] = control::ToString(onboard_.status().mission.mode);
  json["gate"] = control::ToString(onboard_.status().mission.gate);
  json["clearance"] = std::isfinite(clearance_) ? FlightReport(clearance_) : FlightReport();
  json["least_clearance"] =
      std::isfinite(least_clearance_) ? FlightReport(least_clearance_) : FlightReport();
  json["events"] = FlightReport::array();
  for (const Event& event : events_)
    json["events"].push_back({{"t", event.t}, {"text", event.text}});
  events_.clear();
  json["outcome"] = outcome_
                        ? FlightReport{{"name", outcome_->name}, {"sentence", outcome_->sentence}}
                        : FlightReport();
  json["plan"] = FlightReport();
  if (answer_is_new_) {
    estimation::BeliefPredictor predictor;
    const estimation::PadPrediction& predicted =
        asked_->request.pad ? predictor.Predict(*asked_->request.pad) : estimation::UnknownPad();
    json["plan"] = AnswerJson(answer_, predicted, asked_->request.input.t_now);
    json["map"] = MapReport();
    answer_is_new_ = false;
  } else {
    json["map"] = {{"added", FlightReport::array()}, {"removed", FlightReport::array()}};
  }
  json["belief"] = FlightReport();
  if (onboard_.pad().initialized()) {
    const estimation::PadState believed = onboard_.pad().Estimate(vehicle_.t);
    json["belief"] = {{"p", VectorJson(believed.p_WP)},
                      {"yaw", believed.yaw},
                      {"sigma", onboard_.pad().PositionSigma(vehicle_.t)}};
  }
  return json;
}

nlohmann::ordered_json PointFlight::Explain() const {
  if (!asked_) return {};
  planning::Replanner replanner(PlannerOf(scene_), solvers::StandardBackends());
  replanner.Restore(before_);
  estimation::BeliefPredictor predictor;
  planning::ReplanInput input = asked_->request.input;
  const estimation::PadPrediction& pad =
      asked_->request.pad ? predictor.Predict(*asked_->request.pad) : estimation::UnknownPad();
  input.pad = asked_->request.pad ? &pad : nullptr;
  planning::ReplanLog log;
  replanner.set_log(&log);
  const planning::ReplanResult& result =
      asked_->request.rest_climb
          ? replanner.Rest(input, *asked_->request.rest_climb, onboard_.map())
          : replanner.Replan(input, onboard_.map());
  FlightReport json = AnswerJson(result, pad, input.t_now);
  json["attempts"] = AttemptsJson(log);
  return json;
}

}  // namespace touchdown::evaluation
