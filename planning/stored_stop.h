// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>

#include "touchdown/planning/limits.h"
#include "touchdown/planning/swept_hull.h"
#include "touchdown/planning/uniform_bspline.h"

namespace touchdown::planning {

/// What is committed: a curve until the moment at which a newer pair can take over at the latest, and from
/// then on a stop that was proven with it. It is flown without being asked.
struct FlightPair {
  UniformBspline curve;
  double t_stop = std::numeric_limits<double>::infinity();  ///< the stop begins [s]; infinite: the
                                                            ///< curve is a stop itself
  UniformBspline stop;

  /// The reference at time t (yaw fields zero). Does not allocate.
  FlatState At(double t) const {
    return t < t_stop ? curve.EvaluateOnward(t) : stop.EvaluateOnward(t);
  }
};

/// Of a curve to contact: the mission has decided by then, and nothing is put off any more [s].
inline constexpr double kLastStretch = 1.2;

/// A plan that is proven as a pair, or why it is not.
struct PairProof {
  bool proven = false;
  bool leaves = false;   ///< it starts among cells that are not observed free: see SweepHull
  bool contact = false;  ///< the stop is the rest of the curve, to contact with the deck
  /// A cell for want of which it is not proven, in W [m].
  std::optional<Eigen::Vector3d> unseen_W;
};

/// Finds a stop for the curve from `pair->curve` and fills t_stop and stop: braking, or where that ends
/// too low in the pad's way a climb clear of the deck, or, where the curve may end in contact (`touches`),
/// the rest of the curve and on to contact; shortly before contact that comes first. The curve until `t_handover` [s] and the stop until rest stay in `hull`
/// from t_from [s] on. `limits` are what is left of them for the stop. Does not allocate if pair->stop
/// has held one before.
PairProof ProvePair(double t_from, double t_handover, bool touches, const Limits& limits,
                    const HullSpace& hull, FlightPair* pair);

/// The same of a curve that ends at rest: all of it is the stop. Fills t_stop.
PairProof ProveStop(double t_from, const HullSpace& hull, FlightPair* pair);

}  // namespace touchdown::planning
