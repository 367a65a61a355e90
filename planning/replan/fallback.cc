// SPDX-License-Identifier: BSD-3-Clause
// The steps of the ladder below a plan (fallback_ladder.h). Each is proven as a pair like any plan:
// the committed curve with a newer stop, a wanted rest, an escape from an obstacle's zone. Below
// them is the stop that was stored with the committed pair. It is flown without further questions.

#include "planning/replan/fallback.h"

#include <cmath>
#include <limits>

#include "planning/replan/plan_attempt.h"
#include "planning/search/grid_search.h"
#include "touchdown/planning/certify/curve_check.h"
#include "touchdown/planning/replan/stage_timer.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::planning {

namespace {

constexpr double kAtRest = 0.05;  // below this speed and way to go [m/s, m]

}  // namespace

Fallback::Fallback(const Limits& limits) : limits_(limits) {
  pair_.curve.Reserve(PlanAttempt::kMostControlPoints);
  pair_.stop.Reserve(PlanAttempt::kMostControlPoints);
}

bool Fallback::NoTimeToBrake(const SplineState& start, const FreeSpace& space) {
  MakeRestTrajectory(start, 0.0, Eigen::Vector3d::Zero(), limits_, &pair_.stop);
  return std::isfinite(FirstBlockedTime(pair_.stop, 0.0, space));
}

bool Fallback::AtRest(const FlightPair& committed, double t0, bool planned) {
  const FlatState now = committed.At(t0);
  const bool leads_on = planned && t0 < committed.t_stop;
  const UniformBspline& last = leads_on ? committed.curve : committed.Last();
  const SplineState end = last.AtKnot(last.segments());
  return now.v_WB.norm() <= kAtRest && end.v.norm() <= 1e-6 && (end.p - now.p_WB).norm() <= kAtRest;
}

Fallback::Landing Fallback::LookAtLanding(const FlightPair& committed, double t0,
                                          const HullSpace& hull) {
  if (!committed.Lands()) return Landing::kHolds;
  if (t0 > committed.curve.t_end() + kLatestContact) return Landing::kMisses;
  if (hull.pad == nullptr) return Landing::kHolds;
  const double t_contact = ContactTime(committed.curve, t0, hull);
  if (!std::isfinite(t_contact)) return Landing::kMisses;
  // Cells that are not seen any more were proven once; cells seen to block are a reason to stop.
  if (SweepAgain(committed, t0, hull, true).unseen_W) return Landing::kMisses;
  return TouchesSoftly(committed.curve, t_contact, 1.0, hull) ? Landing::kHolds : Landing::kHard;
}

Sweep Fallback::SweepAgain(const FlightPair& committed, double t0, const HullSpace& hull,
                           bool unseen_passes) {
  HullSpace bare = hull;  // the margins may have grown since
  bare.margin = 0.0;
  bare.unseen_passes = unseen_passes;
  const UniformBspline& last = committed.Last();
  const double t_from = std::max(t0, last.t0());
  const double t_contact = committed.Lands() ? ContactTime(last, t_from, hull) : last.t_end();
  const double t_to = std::max(t_from, std::isfinite(t_contact) ? t_contact : last.t_end());
  return SweepHull(last, t_from, t_to, {last.EvaluateOnward(t_from).p_WB, t_from}, bare, kAnyTime);
}

bool Fallback::GoesOn(const FlightPair& committed, double t0, double t_stop, const HullSpace& hull,
                      ReplanResult* result) {
  if (t0 >= committed.t_stop) return false;  // its curve is behind it
  StageTimer timer(&result->times.certificate, StageTimer::kWhileLogged);
  pair_.curve = committed.curve;
  const PairEnd ends = result->ends_in_contact ? PairEnd::kRestOrContact : PairEnd::kRest;
  const PairProof proof = ProvePair(t0, t_stop, ends, limits_, hull, &pair_);
  if (!proof.proven) return false;
  result->pair() = pair_;
  result->certificate = Certify(pair_.curve, t0, nullptr, nullptr, limits_, *hull.space);
  Enter(proof, &result->certificate);
  return true;
}

bool Fallback::Rests(double t0, const SplineState& start, const Eigen::Vector3d& shift,
                     const HullSpace& hull, Room room, ReplanResult* result) {
  StageTimer timer(&result->times.certificate, StageTimer::kWhileLogged);
  MakeRestTrajectory(start, t0, shift, limits_, &pair_.curve);
  const PairProof proof = ProveStop(t0, hull, &pair_);
  Certificate certificate = Certify(pair_.curve, t0, nullptr, nullptr, limits_, *hull.space);
  Enter(proof, &certificate);
  const bool enough =
      room == Room::kPlanClearance ? certificate.passed() : proof.proven && certificate.limits_kept;
  if (!enough) return false;
  result->pair() = pair_;
  result->certificate = certificate;
  return true;
}

void Fallback::RisesUnproven(double t0, const SplineState& start, double climb,
                             const HullSpace& hull, ReplanResult* result) const {
  MakeRestTrajectory(start, t0, {0.0, 0.0, climb}, limits_, &result->curve);
  result->t_stop = std::numeric_limits<double>::infinity();
  result->proven = false;
  result->certificate = Certify(result->curve, t0, nullptr, nullptr, limits_, *hull.space);
}

bool Fallback::Escapes(double t0, const SplineState& start, const HullSpace& hull,
                       ReplanResult* result) {
  CellIndex way_out = hull.space->map->CellOf(start.p);
  return hull.space->Blocked(start.p) && GridSearch::NearestFree(*hull.space, &way_out) &&
         Rests(t0, start, hull.space->map->CentreOf(way_out) - start.p, hull, Room::kPlanClearance,
               result);
}

void Fallback::FlyStop(const FlightPair& committed, double t0, const HullSpace& hull,
                       ReplanResult* result) {
  result->status = committed.Lands()              ? ReplanStatus::kKept
                   : AtRest(committed, t0, false) ? ReplanStatus::kHolding
                                                  : ReplanStatus::kBraking;
  result->pair() = committed;
  if (t0 >= committed.t_stop) result->curve = committed.stop;
  Certificate& certificate = result->certificate = {};
  certificate.earlier = true;
  certificate.endpoint_required = false;
  certificate.limits_kept = certificate.clear = true;
  certificate.speed_bound = certificate.acceleration_bound = certificate.body_rate_bound =
      certificate.clearance = std::numeric_limits<double>::quiet_NaN();
  certificate.stops_in_observed_space = committed.proven && !result->from_odometry &&
                                        LookAtLanding(committed, t0, hull) != Landing::kMisses;
  // A landing is checked against the deck, or not at all.
  const bool looked_at = hull.space != nullptr && (hull.pad != nullptr || !committed.Lands());
  if (looked_at) {
    const Sweep now = SweepAgain(committed, t0, hull, false);
    result->map_error = !now.proven || now.start.occupied;
  }
}

}  // namespace touchdown::planning
