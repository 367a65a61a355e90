// SPDX-License-Identifier: BSD-3-Clause
// Single replanning steps in random forests: the scenes that EGO-Planner was measured in, for this
// project's replanner.
#pragma once

#include <memory>

#include "touchdown/estimation/pad_prediction.h"
#include "touchdown/evaluation/forest_scene.h"
#include "touchdown/planning/occupancy_map.h"
#include "touchdown/planning/replanner.h"
#include "touchdown/sim/obstacle_field.h"

namespace touchdown::evaluation {

/// An end that moves at a constant velocity: at `p` at the time `t` [s].
class MovingTarget : public estimation::PadPrediction {
 public:
  MovingTarget(const Eigen::Vector3d& p, const Eigen::Vector3d& v, double t)
      : p_(p), v_(v), t_(t) {}
  estimation::PadState At(double t) const noexcept override;

 private:
  Eigen::Vector3d p_, v_;
  double t_;
};

/// One scene, with all obstacles within 12 m of the start known.
struct ReplanScene {
  sim::ObstacleField field;
  std::unique_ptr<planning::OccupancyMap> map;
  planning::SplineState start;                       ///< at t = 0
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< free; where the end is after `duration`
  std::unique_ptr<MovingTarget> end;
  double duration = 0.0;         ///< the replanner's own guess for that end [s]
  double target_moved = 0.0;     ///< out of an obstacle, by this much [m]
  bool straight_blocked = true;  ///< an obstacle is in the straight way
  /// The target was free or moved less than 1 m, A* on the known map joins start and target within
  /// 1.3 times the straight length, and full braking from the start is free.
  bool feasible = false;
};

/// What the replanner of a scene's kind is asked with. `base`: backend, formulation, guides.
planning::ReplannerOptions SceneReplannerOptions(const SceneOptions& options,
                                                 planning::ReplannerOptions base);

/// Scene `index`: a forest scene whose end passes a point one horizon ahead with up to half the speed
/// limit in any direction. Scenes whose start is blocked, or where no time is the one that the replanner
/// guesses for an end that moves so, are drawn again. The same options and index give the same scene.
/// Throws std::invalid_argument for an option out of range, BadInput for a horizon that no map of this
/// resolution holds.
ReplanScene DrawReplanScene(const SceneOptions& options, int index);

/// Puts the replanner at the scene's start: it is flying there at the start's velocity.
planning::ReplanInput AskAt(const ReplanScene& scene, planning::Replanner* replanner);

}  // namespace touchdown::evaluation
