// SPDX-License-Identifier: BSD-3-Clause
// The ladder below a plan: keep what is committed while it is safe, else come to rest on a quintic that is
// certified like any plan: out of an obstacle's zone, as the caller wishes, by braking, by climbing.

#include "touchdown/planning/fallback.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "touchdown/planning/curve_check.h"
#include "touchdown/planning/grid_search.h"
#include "touchdown/planning/plan_attempt.h"
#include "touchdown/planning/rest_trajectory.h"
#include "touchdown/planning/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr double kMoving = 1e-6;  // [m/s]
constexpr double kClimb = 1.5;    // [m]
constexpr double kAtRest = 0.05;  // below this speed and way to go [m/s, m]

const Eigen::Vector3d kNoShift = Eigen::Vector3d::Zero();

}  // namespace

Fallback::Fallback(const Limits& limits, double reaction) : limits_(limits), reaction_(reaction) {
  braking_.Reserve(PlanAttempt::kMostControlPoints);
}

bool Fallback::NoTimeToBrake(const SplineState& start, const FreeSpace& space) {
  MakeRestTrajectory(start, 0.0, kNoShift, limits_, &braking_);
  return std::isfinite(FirstBlockedTime(braking_, 0.0, space));
}

bool Fallback::Stays(const UniformBspline& committed, const SplineState& start) {
  const SplineState last = committed.AtKnot(committed.segments());
  return start.v.norm() <= kAtRest && last.v.norm() <= kMoving &&
         (last.p - start.p).norm() <= kAtRest;
}

bool Fallback::KeepsCommitted(const UniformBspline& committed, double t0, const SplineState& start,
                              const FreeSpace& space, ReplanResult* result) {
  const Certificate now = Certify(committed, t0, nullptr, nullptr, limits_, reaction_, space);
  const bool moves_at_end = committed.AtKnot(committed.segments()).v.norm() > kMoving;
  const bool at_rest = !space.Blocked(start.p) && Stays(committed, start);
  const bool leaves = now.escaping && now.passed();
  if (!at_rest && !leaves) {
    if (!now.stops_in_observed_space) return false;
    MakeRestTrajectory(start, t0, kNoShift, limits_, &braking_);
    const double never = std::numeric_limits<double>::infinity();
    const double hit = now.clear ? never : now.first_hit_t;
    const double end = moves_at_end ? committed.t_end() : never;
    if (std::min(hit, end) <= t0 + braking_.duration() + reaction_) return false;
  }
  result->status = at_rest ? ReplanStatus::kHolding : ReplanStatus::kKept;
  result->curve = committed;
  result->certificate = now;
  return true;
}

bool Fallback::TryRest(double t0, const SplineState& start, const Eigen::Vector3d& shift,
                       const FreeSpace& space, ReplanResult* result) const {
  MakeRestTrajectory(start, t0, shift, limits_, &result->curve);
  StageTimer timer(&result->times.certificate, StageTimer::kWhileLogged);
  result->certificate = Certify(result->curve, t0, nullptr, nullptr, limits_, reaction_, space);
  return result->certificate.passed();
}

void Fallback::ComeToRest(double t0, const SplineState& start, double climb, const FreeSpace& space,
                          ReplanResult* result) const {
  CellIndex way_out = space.map->CellOf(start.p);
  const bool inside = space.Blocked(start.p) && GridSearch::NearestFree(space, &way_out);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto rests = [&](const Eigen::Vector3d& shift) {
    return TryRest(t0, start, shift, space, result);
  };
  if (inside && rests(space.map->CentreOf(way_out) - start.p)) {
    result->status = ReplanStatus::kEscaping;
  } else if (climb > 0.0 && rests(climb * up)) {
    result->status = ReplanStatus::kClimbing;
  } else if (rests(kNoShift)) {
    result->status = ReplanStatus::kBraking;
  } else if (climb <= 0.0 && rests(kClimb * up)) {
    result->status = ReplanStatus::kClimbing;
  } else {
    // Nothing is certified. Of what is left, braking meets any obstacle slowest.
    result->status = ReplanStatus::kUnsafe;
    rests(kNoShift);
  }
}

}  // namespace touchdown::planning
