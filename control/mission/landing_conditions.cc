// SPDX-License-Identifier: BSD-3-Clause
// Gate, corridor, cone and contact. Each is a bound on present estimates, the gate also on predictions for the
// contact.

#include "control/mission/landing_conditions.h"

#include <algorithm>
#include <cmath>

namespace touchdown::control {
namespace {

constexpr double kPlanSlope = 1.8;  // of the approach cone of plans, 60 degrees, for the feet [-]

constexpr double kHeightError =
    0.02;  // one sigma of an estimated own height (docs/results/own_state/tables.md) [m]

// Whether what is known now lasts until contact, were nothing measured on the way.
bool CanBridge(const MissionState& s, const MissionInputs& in, const MissionParameters& p) {
  const bool on_the_way = Planned(in) || s.foot_height <= p.gate_height;
  return on_the_way && in.tag_age + ContactIn(s, in, p) <= p.bridge_time &&
         in.contact_sigma <= p.bridge_sigma;
}

}  // namespace

double HeightLost(const MissionInputs& in, const MissionParameters& p, double time) noexcept {
  const double sinks = std::max(0.0, in.sink_rate);
  return sinks * (time + 0.5 * sinks / p.turn_acceleration);
}

Conditions Assess(const MissionState& s, const MissionInputs& in,
                  const MissionParameters& p) noexcept {
  Conditions now{};
  // pad_sigma, contact_sigma, tag_age and plan_failed_for may be infinite: never seen, never planned.
  now.numbers_valid = std::isfinite(in.horizontal_distance) && std::isfinite(in.height) &&
                      std::isfinite(in.horizontal_speed) && std::isfinite(in.sink_rate) &&
                      std::isfinite(in.foot_force) && std::isfinite(in.lean) &&
                      !std::isnan(in.pad_sigma) && !std::isnan(in.contact_sigma) &&
                      !std::isnan(in.tag_age) && !std::isnan(in.plan_failed_for) &&
                      !std::isnan(in.arrival_in) && !std::isnan(in.depth_age);
  now.sees = in.depth_age <= p.depth_timeout;
  now.pad_good = now.numbers_valid && in.own_usable && in.pad_available && in.pad_converged;
  // Dead reckoning only gets worse: if it lasts, the gate does not wait for its end.
  const bool own_good =
      in.own_usable && (in.own_fresh || LastedLonger(s.own_stale_since, s.t, p.own_patience));
  const bool seen = in.pad_sigma <= p.gate_sigma && in.tag_age <= p.gate_tag_age;
  // A bridge rests on a prediction in W, and dead reckoning leaves W.
  const bool bridged = in.own_fresh && CanBridge(s, in, p);
  now.gate = !now.numbers_valid || !own_good ? Gate::kOwnState
             : !in.pad_available             ? Gate::kNoPad
             : seen || bridged               ? (in.lean <= p.lean_max ? Gate::kOpen : Gate::kGust)
             : in.tag_age > p.gate_tag_age   ? Gate::kTagsUnseen
                                             : Gate::kPadUncertain;
  now.may_land = now.gate == Gate::kOpen;
  now.gate_open = now.may_land || now.gate == Gate::kGust;
  now.in_corridor =
      now.numbers_valid &&
      in.horizontal_distance <= p.corridor_radius + p.corridor_slope * std::max(0.0, in.height);
  const auto in_cone_of = [&](double slope) {
    return now.numbers_valid &&
           in.horizontal_distance <= p.landing_distance + slope * std::max(0.0, in.height);
  };
  now.in_cone = in_cone_of(p.cone_slope);
  now.comes_in = in_cone_of(kPlanSlope);
  now.touching = now.numbers_valid && in.foot_force >= p.contact_force &&
                 std::abs(in.height) <= p.contact_height &&
                 in.horizontal_distance <= p.contact_distance;
  const double lowest_foot = in.height - in.foot_drop;
  now.will_touch = now.numbers_valid && in.pad_available && in.pad_sigma <= p.bridge_sigma &&
                   in.horizontal_distance <= p.foothold && lowest_foot >= -p.contact_height &&
                   lowest_foot <= HeightLost(in, p, p.climb_time) + kHeightError;
  return now;
}

double ContactIn(const MissionState& state, const MissionInputs& in,
                 const MissionParameters& p) noexcept {
  if (Planned(in)) {
    return std::isfinite(in.arrival_in) ? std::max(0.0, in.arrival_in) + p.contact_reserve : kNever;
  }
  if (!std::isfinite(in.height)) return kNever;
  const double way = std::max({0.0, in.height, state.foot_height});
  const double faster = std::max(0.0, p.slow_rate + state.foot_height_rate);  // yet to be gained
  const double speeding_up = 0.5 * faster * faster / (p.height_acceleration * p.slow_rate);
  const double slower = std::max(0.0, p.slow_rate - p.contact_rate);  // yet to be lost
  const double braking = 0.5 * slower * slower / (p.contact_deceleration * p.slow_rate);
  return way / p.slow_rate + speeding_up + braking + p.contact_reserve;
}

}  // namespace touchdown::control
