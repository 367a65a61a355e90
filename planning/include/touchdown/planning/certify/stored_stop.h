// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "touchdown/planning/certify/certificate.h"
#include "touchdown/planning/certify/flight_pair.h"
#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/planning/spline/limits.h"

namespace touchdown::planning {

/// Before contact: the mission has decided by then, and nothing is postponed any more [s].
inline constexpr double kLastStretch = 1.2;
/// After the end of such a curve contact has come by then, or the pair is over [s].
inline constexpr double kLatestContact = 1.7;

/// A plan that is proven as a pair, or why it is not.
struct PairProof {
  bool proven = false;
  StartCells start;
  bool contact = false;  ///< the stop is the rest of the curve, to contact with the deck
  /// A cell that prevents the proof because it was not seen, in W [m].
  std::optional<Eigen::Vector3d> unseen_W;
};

/// What the proof of its pair says of a curve.
void Enter(const PairProof& proof, Certificate* certificate);

/// How a pair may end.
enum class PairEnd { kRest, kRestOrContact, kContact };

/// Finds a stop for the curve from `pair->curve`, and fills t_stop and stop. The stop is the first of
/// these that can be proven:
/// 1. shortly before a contact that the curve may make: the rest of the curve and on to contact;
/// 2. braking, unless it ends too low in the pad's way;
/// 3. a climb;
/// 4. farther from such a contact: as 1.
///
/// The curve until `t_handover` [s] and the stop until rest stay in `hull` from t_from [s] on. `limits` are what is
/// left of them for the stop. Does not allocate if pair->stop has held one before.
PairProof ProvePair(double t_from, double t_handover, PairEnd ends, const Limits& limits,
                    const HullSpace& hull, FlightPair* pair);

/// The same for a curve that ends at rest: all of it is the stop. Fills t_stop.
PairProof ProveStop(double t_from, const HullSpace& hull, FlightPair* pair);

/// Least height at time t [s] of a vehicle that rests in the pad's way, so that the pad may drive on below it; in W
/// [m]. @pre there is a pad.
double LowestRest(double t, const HullSpace& hull);

/// Whether the deck is met with at most `share` of the sink rate and of the drift that the landing rule allows
/// (docs/mission.md). The curve is taken at time t [s], relative to the predicted centre of the pad.
bool TouchesSoftly(const UniformBspline& curve, double t, double share, const HullSpace& hull);

/// When from t_from on the feet meet the deck [s], along the curve or beyond its end, by the pad's present
/// prediction. Infinite where they do not.
double ContactTime(const UniformBspline& curve, double t_from, const HullSpace& hull);

}  // namespace touchdown::planning
