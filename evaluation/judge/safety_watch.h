// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"
#include "touchdown/planning/certify/margins.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::evaluation {

/// Figures of the safety rule in a flight, until first contact (docs/safety.md).
struct SafetyFigures {
  int uncertified_steps =
      0;  ///< after which something flies that is not part of a proven flight pair
  int escaping_steps =
      0;  ///< whose pair starts with the hull in cells that are not observed free, or leads out
          ///< of a zone that blocks
  int escaping_hit_steps = 0;      ///< ... with the hull in occupied cells
  int escaping_unknown_steps = 0;  ///< ... with it in cells that are not known
  int narrow_steps =
      0;  ///< ... with only the margins in such cells, or within the clearance of plans
  int stops_flown = 0;  ///< stored stops that began, for want of a newer pair
  int map_errors = 0;   ///< steps in which the tube of a stop that is flown was not free any more
  double margin_mean_m = 0.0;  ///< over the steps
  double margin_max_m = 0.0;
  int tracking_events =
      0;  ///< times that the vehicle left its reference by more than the margin of then
  double tracking_max_m = 0.0;  ///< largest distance from the reference, as the vehicle knows it
  int drift_events = 0;         ///< times that the own position was off by more than its margin
  double drift_max_m = 0.0;     ///< largest error of the own position
  std::int64_t free_cells = 0;  ///< observed free, over all looks at the map, one a second
  std::int64_t falsely_free_cells = 0;  ///< of those, cells whose centre is inside an obstacle
};

/// Collects the figures. The truth is that of the obstacles. The vehicle's knowledge is in the frame of its estimate.
class SafetyWatch {
 public:
  explicit SafetyWatch(const sim::ObstacleField& obstacles) : obstacles_(obstacles) {}

  /// `late`: a new pair took over later than it was proven for, and the reference jumped.
  void Step(const planning::ReplanResult& plan, const planning::Margins& margins,
            bool late = false);
  /// Estimated, true and reference position.
  void Tracked(const Eigen::Vector3d& p_WB, const Eigen::Vector3d& p_true_WB,
               const Eigen::Vector3d& p_reference_W);
  /// `drift_W` is the vehicle's estimate of its position less the truth [m].
  void LookAt(const planning::OccupancyMap& map, const Eigen::Vector3d& p_WB,
              const Eigen::Vector3d& drift_W);

  const SafetyFigures& figures() const { return figures_; }

 private:
  sim::ObstacleField obstacles_;
  planning::Margins margins_;  // of the pair that is flown
  int steps_ = 0;
  bool stopping_ = false;
  bool off_ = false, drifted_ = false;
  SafetyFigures figures_;
};

}  // namespace touchdown::evaluation
