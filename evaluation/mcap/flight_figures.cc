// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/flight_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "estimation/base/degrees.h"
#include "evaluation/mcap/message_parts.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::evaluation {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::optional<sim::TrueClearance> ClearanceIn(const Scenario& scenario) {
  std::vector<sim::Obstacle> obstacles;
  for (NamedObstacle& named : ObstaclesOf(scenario)) obstacles.push_back(named.obstacle);
  if (obstacles.empty()) return std::nullopt;
  return sim::TrueClearance(sim::ObstacleField(std::move(obstacles)),
                            sim::LoadVehicleModel(VehicleMjcf(scenario)));
}

}  // namespace

std::string StepMessage(int number, const RecordPlan& plan) {
  const ReplanOutcome& result = plan.result;
  const planning::ReplanInput& input = plan.request.input;
  std::string bytes;
  protozero::pbf_writer step(bytes);
  AddTime(&step, 1, input.t_now);
  step.add_uint32(2, static_cast<std::uint32_t>(number));
  step.add_double(3, input.t_start);
  step.add_string(4, planning::ToString(result.status));
  step.add_string(5, planning::ToString(result.reason));
  step.add_bool(6, result.from_odometry);
  unsigned field = 7;
  for (const int count : {result.pairs, result.solves, result.rebinds, result.iterations}) {
    step.add_uint32(field++, static_cast<std::uint32_t>(count));
  }
  step.add_double(11, result.cost);
  step.add_uint32(12, static_cast<std::uint32_t>(result.work));
  step.add_double(13, result.curve.t_end() - input.t_start);
  step.add_double(14, result.certificate.clearance);
  step.add_double(15, result.certificate.speed_bound);
  step.add_double(16, result.certificate.acceleration_bound);
  step.add_double(17, 1e3 * plan.latency_s);
  step.add_double(18, 1e3 * plan.wall_s);
  step.add_double(19, 1e3 * plan.cpu_s);
  return bytes;
}

FlightFigures::FlightFigures(const RecordedFlight& flight, const FlightTrack& track)
    : track_(track), clearance_(ClearanceIn(flight.scenario)) {
  if (flight.scenario.task == TaskKind::kGoTo) goal_ = GoalOf(flight.scenario);
}

const TrackBelief* FlightFigures::PadBelief(int sample) const {
  if (goal_) return nullptr;  // the goal takes its place, and it is known
  const double t = TimeOf(sample);
  const std::vector<TrackBelief>& beliefs = track_.beliefs();
  const auto belief =
      std::lower_bound(beliefs.begin(), beliefs.end(), t,
                       [](const TrackBelief& b, double time) { return b.t < time; });
  return belief == beliefs.end() || belief->t != t ? nullptr : &*belief;
}

std::string FlightFigures::StateMessage(int sample) const {
  const TrackSample& now = At(sample);
  const TrackFigures& figures = track_.figures()[static_cast<std::size_t>(sample)];
  const estimation::VehicleState& vehicle = now.vehicle;
  const Eigen::Vector3d to_pad = now.pad.p_WP - vehicle.p_WB;
  double pad_error = kNone, pad_sigma = kNone;
  if (const TrackBelief* belief = PadBelief(sample)) {
    pad_error = (belief->pad.p_WP - now.pad.p_WP).head<2>().norm();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(belief->pad.cov_p,
                                                              Eigen::EigenvaluesOnly);
    pad_sigma = std::sqrt(std::max(0.0, axes.eigenvalues().maxCoeff()));
  }
  const auto of_pad = [&](double figure) { return goal_ ? kNone : figure; };

  std::string bytes;
  protozero::pbf_writer state(bytes);
  AddTime(&state, 1, TimeOf(sample));
  state.add_string(2, figures.mode);
  unsigned field = 3;
  for (const double figure :
       {vehicle.v_WB.norm(), vehicle.v_WB.z(),
        estimation::Tilt(vehicle.q_WB) * estimation::kDegPerRad,
        estimation::Yaw(vehicle.q_WB) * estimation::kDegPerRad, of_pad(to_pad.head<2>().norm()),
        of_pad(-to_pad.z()), of_pad((now.pad.v_WP - vehicle.v_WB).norm()),
        of_pad(now.pad.v_WP.norm()), pad_error, pad_sigma,
        (figures.p_believed_WB - vehicle.p_WB).norm(),
        (figures.p_reference_WB - figures.p_believed_WB).norm(),
        clearance_ ? clearance_->Distance(vehicle) : kNone, figures.v_air_W.norm()}) {
    state.add_double(field++, figure);
  }
  state.add_packed_double(17, figures.thrusts.begin(), figures.thrusts.end());
  state.add_double(18, goal_ ? (goal_->At(TimeOf(sample)).p_WP - vehicle.p_WB).norm() : kNone);
  return bytes;
}

}  // namespace touchdown::evaluation
