// SPDX-License-Identifier: BSD-3-Clause
// Sensors at their own rates feed the pad filter and the map. Returns from the pad vehicle are no
// obstacles, or the goal of the flight would be one; those that may be from it are kept in doubt until
// the tags tell where it was (touchdown/planning/map/pad_outline.h).
// Map and pad filter live in the frame of the vehicle's own estimate: where it takes W to be. In it
// a sighting is good to the tags' accuracy, but the frame wanders as the estimate does, which the
// pad filter takes for a motion of the pad; and the pad's GPS is off by the estimate's whole error.
// So GPS leads to the pad, with the estimate's doubt added to its own, and tags, once seen, guide
// alone: what the vehicle lands by, the place relative to it, does not suffer from an estimate that
// has drifted.
#include "evaluation/flight/perception.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/base/map_file.h"
#include "evaluation/judge/truth_map.h"
#include "evaluation/scenario/planner_options.h"
#include "touchdown/planning/replan/stage_timer.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

constexpr double kPriorShare = 0.5;  // of the vehicle's speed limit: 1 sigma of the pad's velocity

// With an estimated own state; docs/own_state.md says what they are read off.
constexpr double kOwnPositionSigma = 0.01;  // what the estimate jumps by between images [m]
constexpr double kOwnAttitudeSigma = 0.01;  // [rad]
constexpr double kFrameWander = 1e-3;       // 0.03 m/s that last for about a second [m^2/s]
constexpr double kTagsGuide = 0.5;          // GPS is left out while tags are younger than this [s]

sim::PadGpsConfig GpsConfig(const Scenario& scenario) {
  sim::PadGpsConfig config;
  config.sigma = scenario.gps.sigma;
  config.rate_hz = scenario.gps.rate;
  config.outage_begin_s = scenario.gps.outage[0];
  config.outage_end_s = scenario.gps.outage[1];
  config.outlier_probability = scenario.gps.outliers;
  config.outlier_size = scenario.gps.outlier_size;
  return config;
}

}  // namespace

estimation::PadFilterOptions PadFilterOptionsOf(const Scenario& scenario) {
  estimation::PadFilterOptions options;
  options.model = scenario.pad_estimator == PadEstimatorKind::kPaper
                      ? estimation::PadModel::kPaper
                      : estimation::PadModel::kTurnRate;
  options.pad_height = scenario.pad.deck_height;
  // A pad may be nearly as fast as the vehicle: a narrow prior would gate its first fixes for ever.
  options.speed_prior = std::max(options.speed_prior, kPriorShare * scenario.limits.speed);
  if (scenario.own_state == OwnStateKind::kEstimated) {
    options.own_position_sigma = kOwnPositionSigma;
    options.own_attitude_sigma = kOwnAttitudeSigma;
    options.noise.position += kFrameWander;
  }
  return options;
}

planning::OccupancyMapOptions MapOptions(const Scenario& scenario,
                                         const estimation::VehicleModel& model,
                                         const Registries& registries) {
  planning::OccupancyMapOptions options;
  options.inflation_radius = PlanClearance(scenario, model, registries);
  options.range_noise = scenario.depth.noise;
  options.thinnest_obstacle = scenario.map_thinnest_obstacle;
  return options;
}

Perception::Perception(const Scenario& scenario, const sim::World& world,
                       const Registries& registries, std::uint64_t seed)
    : own_(scenario, world.vehicle(), world.timestep(), seed),
      gps_(GpsConfig(scenario), seed),
      pad_eye_(MakePadEye(scenario, world.config(), seed)),
      depth_eye_(MakeDepthEye(scenario, world.config(), seed)),
      pad_filter_(PadFilterOptionsOf(scenario)),
      map_(MapOptions(scenario, world.model(), registries)),
      persistent_map_(map_.options()),
      deck_half_size_(0.5 * scenario.pad.deck_size),
      pad_is_obstacle_(scenario.task == TaskKind::kGoTo) {
  const bool prior = scenario.map_prior != "none";
  if (prior) ReadMapFile(scenario.map_prior, &persistent_map_);
  map_.Recentre(own_.now().p_WB);
  if (prior) persistent_map_.Refill(&map_);
  map_.MarkFree(own_.now().p_WB, scenario.map_start_free);
  if (scenario.map_observed_free == ObservedFreeKind::kTruth) truth_ = world.config().obstacles;
}

void Perception::Sense(const sim::World& world) {
  const double begin = solvers::ThreadCpuSeconds();
  const double t = world.time();
  const estimation::VehicleState vehicle = world.vehicle();
  const estimation::PadState pad = world.pad();
  SenseOwn(vehicle);
  SensePad(vehicle, pad);
  depth_eye_->Look(vehicle, pad, &sensing_times_);
  const double sensed = solvers::ThreadCpuSeconds();
  sensing_cpu_s_ += sensed - begin;
  image_taken_ = false;
  while (auto glimpse = depth_eye_->Poll(t)) {
    image_taken_ = true;
    frame_times_ = {};
    frame_times_.sense = glimpse->sense;
    {
      const planning::StageTimer timer(&frame_times_.map);
      if (own_.estimated()) {
        PlaceFrame(glimpse->vehicle, own_.At(glimpse->vehicle), &glimpse->frame);
      }
      UpdateMap(t, glimpse->frame);
    }
    if (truth_) ObserveTruth(*truth_, own_.now().p_WB - vehicle.p_WB, &map_);
    depth_eye_->Recycle(std::move(*glimpse));
  }
  if (image_taken_) mapping_cpu_s_ += solvers::ThreadCpuSeconds() - sensed;
}

void Perception::SenseOwn(const estimation::VehicleState& vehicle) {
  if (!own_.estimated()) return own_.Sense(vehicle);
  const double begin = solvers::ThreadCpuSeconds();
  own_.Sense(vehicle);
  sensing_times_.own_state += solvers::ThreadCpuSeconds() - begin;
}

bool Perception::TagsGuide(double t) const {
  return own_.estimated() && pad_filter_.TagAge(t) < kTagsGuide;
}

void Perception::SensePad(const estimation::VehicleState& vehicle,
                          const estimation::PadState& pad) {
  const double t = vehicle.t;
  pad_measured_ = false;
  // Most steps bring nothing: the clock is read only if something has arrived.
  const auto timed = [this, t](const auto& measurement, const auto& update) {
    if (pad_log_ != nullptr) pad_log_->push_back({t, measurement});
    const double begin = solvers::ThreadCpuSeconds();
    update();
    sensing_times_.pad_filter += solvers::ThreadCpuSeconds() - begin;
    pad_measured_ = true;
  };
  if (auto fix = gps_.Poll(t, pad); fix && !TagsGuide(t)) {
    fix->sigma = std::hypot(fix->sigma, own_.HorizontalSigma());
    timed(*fix, [&] { pad_filter_.AddGps(*fix); });
  }
  pad_eye_->Look(vehicle, own_.now(), pad, pad_filter_, &sensing_times_);
  while (const auto glimpse = pad_eye_->Poll(t)) {
    const BelievedSighting seen{glimpse->sighting, own_.At(glimpse->vehicle)};
    timed(seen, [&] { pad_filter_.AddSighting(seen.sighting, seen.believed); });
  }
}

void Perception::UpdateMap(double t, const estimation::DepthFrame& frame) {
  persistent_map_.Recentre(own_.now().p_WB, &map_);
  map_.Integrate(frame, Outline(t, frame.t));
  const planning::PadOutline now = Outline(t, t);
  if (pad_filter_.initialized() && now.Known()) {
    map_.ExplainDoubts([&](double at) { return Outline(t, at); });
  }
}

// Where the pad was at `stamp`, with the doubt of then and of today.
planning::PadOutline Perception::Outline(double t, double stamp) const {
  if (pad_is_obstacle_ || !pad_filter_.initialized()) return {};
  planning::PadOutline outline = planning::OutlineOf(pad_filter_.Estimate(stamp), deck_half_size_);
  outline.sigma = std::max(outline.sigma, pad_filter_.PositionSigma(t));
  return outline;
}

planning::PersistentMap Perception::TakePersistentMap() {
  persistent_map_.Flush(&map_);
  return std::move(persistent_map_);
}

}  // namespace touchdown::evaluation
