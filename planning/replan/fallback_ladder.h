// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "planning/replan/fallback.h"
#include "touchdown/planning/certify/stored_stop.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/planning/spline/endpoint.h"
#include "touchdown/planning/spline/limits.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// The inputs of the ladder below a plan.
struct FallbackFacts {
  const FlightPair* committed = nullptr;
  bool planned = false;  ///< the committed curve is a plan to the pad
  SplineState start;
  Eigen::Vector3d v_WB{0.0, 0.0, 0.0};  ///< the vehicle's own, on the curve or off it [m/s]
  double t0 = 0.0;        ///< of the start [s]
  double reaction = 0.0;  ///< after which a newer stop begins [s]
  const HullSpace* hull = nullptr;
  EndpointTarget endpoint;
  std::optional<Eigen::Vector3d> look_from_W;  ///< the vehicle goes there to look [m]
};

/// The result of the ladder.
struct [[nodiscard]] Fallen {
  bool commits = false;  ///< the result's pair takes over; else what is committed goes on
  bool on_plan = false;  ///< what is flown then, new or not, is a plan to the pad
};

/// Whether the committed pair will soon make a contact that is still wanted. Nothing is postponed then: the pair was
/// proven until there.
bool LandsSoon(const FlightPair& committed, double t0, const EndpointTarget& endpoint,
               const HullSpace& hull);

/// That contact is soft, and near the deck's middle.
bool LandsWell(const FlightPair& committed, double t0, const HullSpace& hull);

/// What is flown if no plan was certified. The first of these that is proven:
/// 1. the committed landing;
/// 2. the committed curve with a newer stop;
/// 3. a way out, from rest;
/// 4. a straight move to where the vehicle wants to look from, or towards it;
/// 5. a rest;
/// 6. after a landing that misses: up, proven or not; else the stored stop.
///
/// Does not allocate.
class FallbackLadder {
 public:
  explicit FallbackLadder(const Limits& limits) : fallback_(limits) {}

  /// The limits that the pull of this step leaves.
  void SetLimits(const Limits& limits) { fallback_.SetLimits(limits); }

  /// Fills curve, stop, certificate, status, and the map's findings. @pre `result` has the reason, the cell that was
  /// not seen, whether tracking is lost, and whether a plan may end in contact.
  Fallen StepDown(const FallbackFacts& facts, ReplanResult* result);

  /// The caller asked for a rest, `climb` higher [m], or as much of that as a roof leaves.
  /// @param under_way  the climb for which the committed rest was asked, and on return the answer
  Fallen Rest(const FallbackFacts& facts, double climb, std::optional<double>* under_way,
              ReplanResult* result);

  /// The committed curve, with a newer stop.
  bool GoesOn(const FallbackFacts& facts, ReplanResult* result);

  /// The start itself leads into an obstacle: arriving later does not change that.
  bool NoTimeToBrake(const SplineState& start, const FreeSpace& space) {
    return fallback_.NoTimeToBrake(start, space);
  }

 private:
  bool Stops(const FallbackFacts& facts, const Eigen::Vector3d& shift, Fallback::Room room,
             ReplanResult* result);

  Fallback fallback_;
};

}  // namespace touchdown::planning
