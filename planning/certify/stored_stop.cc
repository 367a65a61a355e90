// SPDX-License-Identifier: BSD-3-Clause
// The pair of a curve and its stop: the stop that is proven here is the one that is flown
// (docs/safety.md). By induction the vehicle touches no standing obstacle as long as observed-free
// cells are free and the margins hold. Either a newer pair takes over before the stop, or the stop
// is flown.

#include "touchdown/planning/certify/stored_stop.h"

#include <algorithm>
#include <cmath>

#include "touchdown/planning/map/pad_outline.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::planning {

namespace {

constexpr double kFeetAboveDeck = 0.1;  // of the feet of a vehicle that rests in the pad's way [m]
constexpr double kClimb = 1.0;          // where braking on the level is not proven [m]
constexpr double kPressing = 0.2;  // past the contact that is expected, until it is noticed [s]
constexpr double kContactClock = 0.01;  // of the time at which contact is expected [s]
constexpr double kOnward = kLatestContact - kPressing;  // from a curve's end to contact at most [s]

/// What stops brake with.
Limits LimitsOfStops(const Limits& limits) {
  Limits stops = limits;
  stops.acceleration *= limits.braking_factor;
  return stops;
}

/// How far a vehicle that rests at p has to rise so that the pad may drive on below it [m].
double TooLow(const Eigen::Vector3d& p, double t, const HullSpace& hull) {
  if (hull.pad == nullptr || !hull.space->OverPad(p)) return 0.0;
  return std::max(0.0, LowestRest(t, hull) - p.z());
}

/// Of the feet above the deck, wherever that is [m].
double FeetAbove(const UniformBspline& curve, double t, const HullSpace& hull) {
  return curve.EvaluateOnward(t).p_WB.z() - hull.foot_depth - hull.pad->MeanAt(t).p_WP.z();
}

}  // namespace

double LowestRest(double t, const HullSpace& hull) {
  return hull.pad->MeanAt(t).p_WP.z() + hull.foot_depth + kFeetAboveDeck;
}

void Enter(const PairProof& proof, Certificate* certificate) {
  certificate->stops_in_observed_space = proof.proven;
  certificate->start_cells = proof.start;
}

PairProof ProvePair(double t_from, double t_handover, PairEnd ends, const Limits& limits,
                    const HullSpace& hull, FlightPair* pair) {
  PairProof proof;
  const UniformBspline& curve = pair->curve;
  const HullStart start{curve.EvaluateOnward(t_from).p_WB, t_from};
  const double t_contact = ends == PairEnd::kRest ? kNever : ContactTime(curve, t_from, hull);
  const Sweep until = SweepHull(curve, t_from, t_handover, start, hull, t_contact);
  const auto note = [&](const Sweep& sweep) {
    proof.start = until.start | sweep.start;
    if (!sweep.proven && !proof.unseen_W) proof.unseen_W = sweep.unseen_W;
    return sweep.proven;
  };
  if (!note(until)) return proof;
  const FlatState from = curve.EvaluateOnward(t_handover);
  const SplineState state{from.p_WB, from.v_WB, from.a_WB};
  const Limits stops = LimitsOfStops(limits);
  const auto rests = [&](double climb) {
    MakeRestTrajectory(state, t_handover, {0.0, 0.0, climb}, stops, &pair->stop);
    const Eigen::Vector3d p_rest = pair->stop.Position(pair->stop.t_end());
    if (TooLow(p_rest, pair->stop.t_end(), hull) > 1e-6) return false;
    const Sweep sweep = SweepHull(pair->stop, t_handover, pair->stop.t_end(), start, hull, kNever);
    return note(sweep);
  };
  const auto touches_down = [&] {
    if (!std::isfinite(t_contact)) return false;
    if (!TouchesSoftly(curve, t_contact, kLandingRoom, hull)) return false;
    const double t_end = std::max(t_handover, t_contact) + kPressing;
    const Sweep sweep = SweepHull(curve, t_handover, t_end, start, hull, t_contact);
    return note(sweep);
  };
  // Shortly before contact, braking over the deck is the more dangerous option.
  const bool arrives = ends == PairEnd::kContact || t_contact - t_handover < kLastStretch;
  if (arrives && touches_down()) {
    proof.proven = proof.contact = true;
  } else if (ends != PairEnd::kContact) {
    proof.proven = rests(0.0);
    if (!proof.proven) {
      const Eigen::Vector3d p_rest = pair->stop.Position(pair->stop.t_end());
      const double lift = TooLow(p_rest, pair->stop.t_end(), hull);
      proof.proven = rests(lift > 0.0 ? lift + kFeetAboveDeck : kClimb);
    }
    if (!proof.proven && !arrives) proof.proven = proof.contact = touches_down();
  }
  pair->t_stop = proof.contact ? std::numeric_limits<double>::infinity() : t_handover;
  return proof;
}

bool TouchesSoftly(const UniformBspline& curve, double t, double share, const HullSpace& hull) {
  const Eigen::Vector3d v = curve.EvaluateOnward(t).v_WB - hull.pad->MeanAt(t).v_WP;
  return IsSoft(v, share);
}

double ContactTime(const UniformBspline& curve, double t_from, const HullSpace& hull) {
  if (hull.pad == nullptr) return kNever;
  const auto over_deck = [&](double t) {
    return OutlineOf(hull.pad->At(t), hull.deck_half_size).SurelyOver(curve.EvaluateOnward(t).p_WB);
  };
  double above = std::max(t_from, curve.t_end());
  const double left = FeetAbove(curve, above, hull);
  if (left > 0.0) {
    const double sinks = hull.pad->MeanAt(above).v_WP.z() - curve.EvaluateOnward(above).v_WB.z();
    const double t = sinks > 0.0 ? above + left / sinks : kNever;
    return t <= curve.t_end() + kOnward && over_deck(t) ? t : kNever;
  }
  // The feet cross the deck's face before the curve ends.
  double below = above;
  above = t_from;
  while (below - above > kContactClock) {
    const double t = 0.5 * (above + below);
    (FeetAbove(curve, t, hull) > 0.0 ? above : below) = t;
  }
  return over_deck(below) ? below : kNever;
}

PairProof ProveStop(double t_from, const HullSpace& hull, FlightPair* pair) {
  pair->t_stop = std::numeric_limits<double>::infinity();
  const UniformBspline& curve = pair->curve;
  const double t_rest = curve.t_end();
  if (TooLow(curve.Position(t_rest), t_rest, hull) > 1e-6) return {};
  const HullStart start{curve.EvaluateOnward(t_from).p_WB, t_from};
  const Sweep sweep = SweepHull(curve, t_from, t_rest, start, hull, kNever);
  return {sweep.proven, sweep.start, false, sweep.unseen_W};
}

}  // namespace touchdown::planning
