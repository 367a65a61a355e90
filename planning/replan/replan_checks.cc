// SPDX-License-Identifier: BSD-3-Clause
#include "planning/replan/replan_checks.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "planning/spline/fastest_leg.h"

namespace touchdown::planning {

namespace {

// Numbers beyond these count as faults.
constexpr double kFastest = 1e3;   // [m/s], [m/s^2]
constexpr double kLongest = 1e3;   // from now to the start [s]
constexpr int kMostPairs = 1000;   // of a control point: each has its storage

bool Near(const Eigen::Vector3d& p) { return p.cwiseAbs().maxCoeff() < kFarthestPlace; }
bool Slow(const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff() < kFastest; }

void Require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument(std::string("ReplannerOptions: ") + name + " is " +
                              std::to_string(value) + ", it must be " + range);
}

bool Plausible(const Margins& margins) {
  const auto fine = [](double margin) { return margin >= 0.0 && margin < kFarthestPlace; };
  return fine(margins.own_state) && fine(margins.attitude) && fine(margins.tracking);
}

}  // namespace

const char* WrongInState(const ReplanInput& input) {
  const estimation::VehicleState& vehicle = input.vehicle;
  if (!std::isfinite(input.t_now)) return "t_now is not finite";
  if (!std::isfinite(input.t_start)) return "t_start is not finite";
  if (input.t_start < input.t_now) return "t_start is before t_now";
  if (input.t_start - input.t_now > kLongest) return "t_start is more than 1000 s after t_now";
  if (!vehicle.p_WB.allFinite()) return "vehicle.p_WB is not finite";
  if (!vehicle.v_WB.allFinite()) return "vehicle.v_WB is not finite";
  if (!Near(vehicle.p_WB)) {
    return "vehicle.p_WB is a million metres away or farther: subtract an origin near the flight "
           "from all positions";
  }
  if (!Slow(vehicle.v_WB)) return "vehicle.v_WB is 1000 m/s or faster";
  if (!input.pull_W.allFinite()) return "pull_W is not finite";
  if (!Slow(input.pull_W)) return "pull_W is 1000 m/s^2 or more";
  return Plausible(input.margins) ? nullptr : "a margin is below 0, or a million metres or more";
}

const char* WrongInPad(const ReplanInput& input, double horizon) {
  if (input.pad == nullptr) return "there is no pad and no goal";
  for (const double t : {input.t_start, input.t_start + horizon}) {
    const estimation::PadState pad = input.pad->At(t);
    if (!pad.p_WP.allFinite() || !pad.v_WP.allFinite()) return "the pad or goal is not finite";
    if (!std::isfinite(pad.yaw)) return "the pad's yaw is not finite";
    if (!pad.cov_p.allFinite()) return "the pad's covariance is not finite";
    if (!Near(pad.p_WP)) {
      return "the pad or goal is a million metres away or farther: subtract an origin near the "
             "flight from all positions";
    }
    if (!Slow(pad.v_WP)) return "the pad or goal moves with 1000 m/s or faster";
    if (!Slow(pad.a_WP)) return "the pad or goal accelerates with 1000 m/s^2 or more";
  }
  return nullptr;
}

const char* WrongInTarget(const ReplanInput& input, double horizon) {
  const EndpointTarget& end = input.endpoint;
  for (const double number : {end.t_reference, end.height, end.sink_rate, end.height_floor}) {
    if (!std::isfinite(number)) return "a number of the endpoint is not finite";
  }
  if (!(end.arrival_sink >= 0.0) || !std::isfinite(end.arrival_sink)) {
    return "endpoint.arrival_sink is not finite, or below 0";
  }
  if (!end.passing_W.allFinite()) return "endpoint.passing_W is not finite";
  if (input.look_from_W && !(input.look_from_W->allFinite() && Near(*input.look_from_W))) {
    return "look_from_W is not finite, or a million metres away";
  }
  if (const char* wrong = WrongInPad(input, horizon)) return wrong;
  for (const double t : {input.t_start, input.t_start + horizon}) {
    const SplineState state = EndStateAt(*input.pad, end, t).state;
    if (!Near(state.p) || !Slow(state.v))
      return "the endpoint is too far from the pad, or too fast";
  }
  return nullptr;
}

bool IsWalkable(const UniformBspline& curve) { return FastestLeg(curve) < kFastest; }

void Validate(const ReplannerOptions& o) {
  for (const StepConstant& constant : StepConstantTable()) {
    const double value = ValueOf(o.constants, constant);
    const std::string range = "finite and >= " + std::to_string(static_cast<int>(constant.least));
    Require(std::isfinite(value) && value >= constant.least, constant.name, value, range.c_str());
  }
  // Each is a factor from one arrival to the next, up to the longest.
  Require(o.constants.end_step >= 1.01, "end_step", o.constants.end_step, ">= 1.01");
  Require(o.constants.stretch >= 1.01, "stretch", o.constants.stretch, ">= 1.01");
  Require(o.limits.speed > 0.0, "limits.speed", o.limits.speed, "> 0 m/s");
  Require(o.limits.acceleration > 0.0, "limits.acceleration", o.limits.acceleration, "> 0 m/s^2");
  Require(o.limits.body_rate > 0.0, "limits.body_rate", o.limits.body_rate, "> 0 rad/s");
  Require(o.limits.braking_factor > 0.0, "limits.braking_factor", o.limits.braking_factor, "> 0");
  for (const double pull : o.limits.pull_W) {
    Require(std::isfinite(pull), "limits.pull_W", pull, "finite");
  }
  const VehicleFacts& vehicle = o.problem.vehicle;
  Require(vehicle.thrust_min >= 0.0, "vehicle.thrust_min", vehicle.thrust_min, ">= 0 m/s^2");
  Require(vehicle.thrust_max > vehicle.thrust_min, "vehicle.thrust_max", vehicle.thrust_max,
          "above thrust_min");
  Require(vehicle.tilt_max > 0.0, "vehicle.tilt_max", vehicle.tilt_max, "> 0 rad");
  Require(vehicle.stop_tilt_max > 0.0, "vehicle.stop_tilt_max", vehicle.stop_tilt_max, "> 0 rad");
  // The proof is of a hull of this size, 0 of a point.
  Require(o.hull_radius >= 0.0 && std::isfinite(o.hull_radius), "hull_radius", o.hull_radius,
          ">= 0 m and finite");
  Require(o.segment_length >= 0.01 && std::isfinite(o.segment_length), "segment_length",
          o.segment_length, ">= 0.01 m and finite");
  Require(std::isfinite(o.contact_height), "contact_height", o.contact_height, "finite");
  Require(o.pad_radius >= 0.0, "pad_radius", o.pad_radius, ">= 0 m");
  Require(o.deck_half_size >= 0.0, "deck_half_size", o.deck_half_size, ">= 0 m");
  Require(o.vertical_cost >= 1.0, "vertical_cost", o.vertical_cost, ">= 1");
  Require(o.problem.max_pairs_per_point <= kMostPairs, "problem.max_pairs_per_point",
          o.problem.max_pairs_per_point, "<= 1000");
  Require(std::isfinite(o.floor_height), "floor_height", o.floor_height, "finite");
  Require(o.ceiling_height > o.floor_height, "ceiling_height", o.ceiling_height,
          "above floor_height");
  Require(o.min_duration > 0.0, "min_duration", o.min_duration, "> 0 s");
  Require(o.max_duration > o.min_duration, "max_duration", o.max_duration, "above min_duration");
  Require(o.min_contact_duration > 0.0, "min_contact_duration", o.min_contact_duration, "> 0 s");
  Require(o.odometry_threshold > 0.0, "odometry_threshold", o.odometry_threshold, "> 0 m");
  Require(o.reaction >= 0.0, "reaction", o.reaction, ">= 0 s");
  Require(o.max_guides >= 1, "max_guides", o.max_guides, ">= 1");
  Require(o.max_rebinds >= 0, "max_rebinds", o.max_rebinds, ">= 0");
  Require(o.max_work >= 1 && o.max_work <= 100000000, "max_work", o.max_work, "in [1, 100000000]");
  Require(o.gap >= 0.0 && o.gap < 1.0, "gap", o.gap, "in [0, 1)");
  Require(o.max_iterations >= 1, "max_iterations", o.max_iterations, ">= 1");
}

}  // namespace touchdown::planning
