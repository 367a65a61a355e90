// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/planning/spline/flatness.h"

namespace touchdown::planning {

/// The planner of a vehicle that lands: it plans, re-plans and holds the committed trajectory. One
/// instance per vehicle; not thread-safe; different instances are independent.
class Planner {
 public:
  virtual ~Planner() = default;

  /// Makes room for maps with this one's window. Otherwise the first step that searches does it, which takes long.
  virtual void Prepare(const OccupancyMap& /*map*/) {}

  /// The vehicle hovers at p_W from t on: the first committed trajectory.
  virtual void CommitHover(const Eigen::Vector3d& p_W, double t) = 0;

  /// What is committed is lost: from position, velocity and acceleration at t on the vehicle brakes, unproven, until an
  /// answer takes over.
  virtual void CommitStop(const FlatState& from, double t) { CommitHover(from.p_WB, t); }

  /// One replanning step against the map. The result stays valid until the next call. It says whether a new answer is
  /// `committed`, or that there was nothing to do (`idle`). A planner with a rate of its own may be asked before an
  /// answer has taken over.
  virtual const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map) = 0;

  /// Comes to rest and stays because there is no pad to go to, or with `climb` > 0 [m] that much higher. `input.pad`,
  /// nullptr where nothing is known of it, is the deck that it may start above. `input.endpoint` says whether a
  /// contact is still wanted.
  virtual const ReplanResult& Rest(const ReplanInput& input, double climb,
                                   const OccupancyMap& map) = 0;

  /// The last answer came too late for its t_start. If it is committed it takes over at t. Until then the trajectory
  /// before it is flown. No step may be asked for before t.
  virtual void TakeOverAt(double t) = 0;

  /// The committed reference at time t (yaw fields zero), NaN at a t that is NaN. Does not allocate.
  virtual FlatState Reference(double t) const = 0;
};

}  // namespace touchdown::planning
