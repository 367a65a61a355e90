// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/certify/stored_stop.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::planning {

/// What is flown where no new plan could be certified: a proven flight pair, except RisesUnproven. Each call fills curve,
/// stop and certificate of `result` if it succeeds. Does not allocate.
class Fallback {
 public:
  explicit Fallback(const Limits& limits);

  /// The limits that the pull of this step leaves.
  void SetLimits(const Limits& limits) { limits_ = limits; }

  /// The curve of the committed pair goes on from t0 to t_stop [s], with a newer stop.
  bool GoesOn(const FlightPair& committed, double t0, double t_stop, const HullSpace& hull,
              ReplanResult* result);

  /// The clearance around a stop.
  enum class Room {
    kPlanClearance,  ///< the clearance of plans is kept, or what is within it is only left
    kHullClearance,  ///< the pair is proven, and no more
  };
  /// From `start` at t0 to rest, `shift` away from where braking ends.
  bool Rests(double t0, const SplineState& start, const Eigen::Vector3d& shift,
             const HullSpace& hull, Room room, ReplanResult* result);

  /// From a landing that misses to rest, `climb` higher [m], where nothing is proven.
  void RisesUnproven(double t0, const SplineState& start, double climb, const HullSpace& hull,
                     ReplanResult* result) const;

  /// From rest among cells that block to the nearest place that does not.
  bool Escapes(double t0, const SplineState& start, const HullSpace& hull, ReplanResult* result);

  /// The stored stop. It was proven when it was made, and needs no more. Nothing is proven if the vehicle is not on
  /// it, or if it is a landing that misses.
  static void FlyStop(const FlightPair& committed, double t0, const HullSpace& hull,
                      ReplanResult* result);

  /// The start itself leads into an obstacle: arriving later does not change that.
  bool NoTimeToBrake(const SplineState& start, const FreeSpace& space);

  /// The vehicle is at rest at t0 [s], and stays at rest on the committed pair: where that is planned, on its curve,
  /// which leads on when it has hardly begun.
  static bool AtRest(const FlightPair& committed, double t0, bool planned);

  /// The state of a pair that was to end in contact.
  enum class Landing {
    kHolds,  ///< or it was none
    kHard,   ///< the deck will be there, but not move along: the landing rule forbids it
    kMisses,  ///< contact is long due, the deck will not be there, or something is seen to be in the way
  };
  static Landing LookAtLanding(const FlightPair& committed, double t0, const HullSpace& hull);

 private:
  /// Sweeps the end of the pair, from t0 on, on the present map and with the hull alone.
  static Sweep SweepAgain(const FlightPair& committed, double t0, const HullSpace& hull,
                          bool unseen_passes);

  Limits limits_;
  FlightPair pair_;
};

}  // namespace touchdown::planning
