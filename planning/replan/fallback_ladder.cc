// SPDX-License-Identifier: BSD-3-Clause
#include "planning/replan/fallback_ladder.h"

#include <algorithm>

namespace touchdown::planning {

namespace {

const Eigen::Vector3d kClimbAfterMiss(0.0, 0.0, 0.5);  // of a landing whose deck is gone [m]
const Eigen::Vector3d kNoShift(0.0, 0.0, 0.0);
constexpr double kTurn = 0.2;        // until a climb is flown [s] ...
constexpr double kRises = 4.0;       // ... and what it ends sinking with [m/s^2]
constexpr double kNearMiddle = 0.2;  // of a deck, where a contact is not put off [m]
// Of a plan: how much less a younger one is off its pad's velocity is mostly noise.
constexpr double kLeastAge = 0.3;  // [s]

/// A climb that begins now touches the deck, too, and bounces off. A vehicle that a gust drives off it does not.
bool TouchesAnyway(const FallbackFacts& facts) {
  const FlightPair& committed = *facts.committed;
  const HullSpace& hull = *facts.hull;
  if (hull.pad == nullptr || !committed.Lands()) return false;
  const FlatState now = committed.At(facts.t0);
  const estimation::PadState pad = hull.pad->MeanAt(facts.t0);
  const double sinks = pad.v_WP.z() - now.v_WB.z();
  const Eigen::Vector3d v_PB(facts.v_WB.x() - pad.v_WP.x(), facts.v_WB.y() - pad.v_WP.y(), -sinks);
  const double feet = now.p_WB.z() - hull.foot_depth - pad.p_WP.z();
  const bool touches = sinks > 0.0 && IsSoft(v_PB, 1.0) &&
                       feet - kFootLowers < sinks * (kTurn + 0.5 * sinks / kRises);
  return touches && Fallback::LookAtLanding(committed, facts.t0, hull) == Fallback::Landing::kHolds;
}

/// The plan was made to end with the pad's velocity. If that goes on changing as it did since, contact will be too hard.
bool PadTurnsAway(const FlightPair& committed, double t0, const HullSpace& hull) {
  const auto v_PB = [&](double t) -> Eigen::Vector2d {
    return (committed.curve.EvaluateOnward(t).v_WB - hull.pad->MeanAt(t).v_WP).head<2>();
  };
  const double t = ContactTime(committed.curve, t0, hull);
  const double age = std::max(kLeastAge, t0 - committed.curve.t0());
  return (v_PB(t) + (t - t0) / age * v_PB(committed.curve.t_end())).norm() >
         kLandingRoom * kSoftDrift;
}

}  // namespace

bool LandsSoon(const FlightPair& committed, double t0, const EndpointTarget& endpoint,
               const HullSpace& hull) {
  return hull.pad != nullptr && endpoint.leads_to_contact() &&
         endpoint.may_touch(hull.foot_depth) && committed.Lands() &&
         ContactTime(committed.curve, t0, hull) - t0 < kLastStretch;
}

bool LandsWell(const FlightPair& committed, double t0, const HullSpace& hull) {
  if (Fallback::LookAtLanding(committed, t0, hull) != Fallback::Landing::kHolds) return false;
  const double t = ContactTime(committed.curve, t0, hull);
  const Eigen::Vector3d off = committed.curve.EvaluateOnward(t).p_WB - hull.pad->MeanAt(t).p_WP;
  return off.head<2>().norm() < kNearMiddle;
}

Fallen FallbackLadder::StepDown(const FallbackFacts& facts, ReplanResult* result) {
  const FlightPair& committed = *facts.committed;
  const HullSpace& hull = *facts.hull;
  const double t0 = facts.t0;
  const Fallback::Landing landing = Fallback::LookAtLanding(committed, t0, hull);
  const bool lands_soon = !result->from_odometry && landing == Fallback::Landing::kHolds &&
                          LandsSoon(committed, t0, facts.endpoint, hull);
  const bool turns_away = lands_soon && !facts.endpoint.at_rest &&
                          PadTurnsAway(committed, t0, hull) && !TouchesAnyway(facts);
  if (lands_soon && !turns_away) {
    Fallback::FlyStop(committed, t0, hull, result);
    return {.commits = false, .on_plan = facts.planned};
  }
  const bool at_rest = !result->from_odometry && Fallback::AtRest(committed, t0, facts.planned);
  const bool on_plan = facts.planned && !result->from_odometry && !at_rest;
  if (on_plan && !turns_away && GoesOn(facts, result)) {
    result->status = ReplanStatus::kKept;
    return {.commits = true, .on_plan = true};
  }
  if (at_rest && fallback_.Escapes(t0, facts.start, hull, result)) {
    result->status = ReplanStatus::kEscaping;
    return {.commits = true};
  }
  if (at_rest && facts.look_from_W) {
    for (const double share : {1.0, 0.5, 0.25}) {
      const Eigen::Vector3d shift = share * (*facts.look_from_W - facts.start.p);
      if (Stops(facts, shift, Fallback::Room::kPlanClearance, result)) return {.commits = true};
    }
  }
  // A landing has no stop of its own, and that of a reference that was lost is elsewhere.
  if (result->from_odometry || committed.Lands()) {
    if (Stops(facts, kNoShift, Fallback::Room::kPlanClearance, result) ||
        Stops(facts, kClimbAfterMiss, Fallback::Room::kPlanClearance, result)) {
      return {.commits = true};
    }
  }
  if (landing == Fallback::Landing::kMisses) {
    if (!Stops(facts, kClimbAfterMiss, Fallback::Room::kHullClearance, result) &&
        !Stops(facts, kNoShift, Fallback::Room::kHullClearance, result)) {
      fallback_.RisesUnproven(t0, facts.start, kClimbAfterMiss.z(), hull, result);
      result->status = ReplanStatus::kBraking;
    }
    return {.commits = true};
  }
  Fallback::FlyStop(committed, t0, hull, result);
  return {.commits = false, .on_plan = turns_away && facts.planned};
}

Fallen FallbackLadder::Rest(const FallbackFacts& facts, double climb,
                            std::optional<double>* under_way, ReplanResult* result) {
  if (!result->from_odometry && TouchesAnyway(facts)) {
    Fallback::FlyStop(*facts.committed, facts.t0, *facts.hull, result);
    return {.commits = false};
  }
  const bool goes_on = *under_way == climb && !result->from_odometry;
  if (!goes_on) {
    under_way->reset();
    const bool at_rest = facts.committed->proven && !result->from_odometry &&
                         Fallback::AtRest(*facts.committed, facts.t0, false);
    // Below a roof a part of the climb takes the vehicle out of the pad's way, too.
    for (const double rise : {climb, 0.5 * climb, 0.25 * climb, 0.0}) {
      if (at_rest && rise == 0.0) break;
      if (!Stops(facts, {0.0, 0.0, rise}, Fallback::Room::kPlanClearance, result)) continue;
      // That none came out is no reason to stop trying.
      if (rise > 0.0 || climb == 0.0) *under_way = climb;
      if (rise > 0.0) result->status = ReplanStatus::kClimbing;
      return {.commits = true};
    }
  }
  FallbackFacts resting = facts;
  resting.planned = false;
  const Fallen fallen = StepDown(resting, result);
  if (goes_on && result->status == ReplanStatus::kBraking) result->status = ReplanStatus::kKept;
  return fallen;
}

bool FallbackLadder::GoesOn(const FallbackFacts& facts, ReplanResult* result) {
  return fallback_.GoesOn(*facts.committed, facts.t0, facts.t0 + facts.reaction, *facts.hull,
                          result);
}

/// A stop that ends `shift` from where braking does [m], if there is one.
bool FallbackLadder::Stops(const FallbackFacts& facts, const Eigen::Vector3d& shift,
                           Fallback::Room room, ReplanResult* result) {
  if (!fallback_.Rests(facts.t0, facts.start, shift, *facts.hull, room, result)) return false;
  result->status = ReplanStatus::kBraking;
  return true;
}

}  // namespace touchdown::planning
