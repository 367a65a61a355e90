// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "touchdown/planning/occupancy_map.h"
#include "touchdown/planning/replan_result.h"
#include "touchdown/sim/obstacle_field.h"

namespace touchdown::evaluation {

/// What became of the safety rule in a flight, until first contact (docs/safety.md).
struct SafetyFigures {
  int uncertified_steps = 0;  ///< after which something flies that is not part of a proven pair
  int escaping_steps = 0;  ///< whose pair starts among cells that are not observed free, or block
  int stops_flown = 0;     ///< stored stops that began, for want of a newer pair
  int map_errors = 0;  ///< steps in which the tube of a stop that is flown was not free any more
  int tracking_events = 0;  ///< times that the vehicle left its reference by more than the margin
  double tracking_max_m = 0.0;  ///< largest distance from the reference, as the vehicle knows it
  std::int64_t free_cells = 0;  ///< observed free, over all looks at the map, one a second
  std::int64_t falsely_free_cells = 0;  ///< of those, cells whose centre is inside an obstacle
};

/// Collects them. The truth is the obstacles'; what the vehicle knows is in the frame of its estimate.
class SafetyWatch {
 public:
  /// `margin` is the distance from the reference that a pair allows for [m].
  SafetyWatch(const sim::ObstacleField& obstacles, double margin)
      : obstacles_(obstacles), margin_(margin) {}

  void Step(const planning::ReplanResult& plan);
  void Tracked(const Eigen::Vector3d& p_WB, const Eigen::Vector3d& p_reference_W);
  /// `drift_W` is the vehicle's estimate of its position less the truth [m].
  void LookAt(const planning::OccupancyMap& map, const Eigen::Vector3d& p_WB,
              const Eigen::Vector3d& drift_W);

  const SafetyFigures& figures() const { return figures_; }

 private:
  sim::ObstacleField obstacles_;
  double margin_;
  bool stopping_ = false;
  bool off_ = false;
  SafetyFigures figures_;
};

}  // namespace touchdown::evaluation
