// SPDX-License-Identifier: BSD-3-Clause
// Single replanning steps in random worlds: the scenes that EGO-Planner was measured in, and harder ones, for
// this project's replanner.
#pragma once

#include <memory>

#include "evaluation/studies/replan/forest_scene.h"
#include "sim/obstacles/obstacle_field.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/replan/replanner.h"

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
  planning::EndpointTarget endpoint;  ///< the end itself, or a point that is passed
  double duration = 0.0;              ///< the replanner's own guess for that end [s]
  double target_moved = 0.0;          ///< out of an obstacle, by this much [m]
  bool straight_blocked = true;       ///< an obstacle is in the straight way
  /// The target was free or moved less than 1 m. A* on the known map joins start and target within
  /// 1.3 times the straight length. Full braking from the start is free.
  bool feasible = false;
};

/// What the replanner of a scene's kind is asked with. `base`: backend, formulation, guides.
planning::ReplannerOptions SceneReplannerOptions(const SceneOptions& options,
                                                 planning::ReplannerOptions base);

/// Scene `index` of the set. Its end passes the target when the replanner's own guess of the duration says. Scenes are
/// drawn again if their start is blocked, or if no time agrees with the replanner's guess for an end that moves so. The
/// same options and index give the same scene. Throws std::invalid_argument for an option out of range, BadInput for a
/// horizon that no map of this resolution holds.
ReplanScene DrawReplanScene(const SceneOptions& options, int index);

/// Puts the replanner at the scene's start: it is flying there at the start's velocity.
planning::ReplanInput AskAt(const ReplanScene& scene, planning::Replanner* replanner);

/// A lower bound of the arrival [s after the start], for a point with limits on the norms of velocity and acceleration,
/// without obstacles. At most 0.01 s below the first time that passes the test, at most 60 s.
double EarliestArrival(const ReplanScene& scene, const planning::Limits& limits);

/// Adds to `map` the part of `all` within `radius` of `centre` [m], as a sensor would have seen it. Nothing else
/// becomes known. What `map` knows already stays, in the same window.
void LearnWithin(const planning::OccupancyMap& all, const Eigen::Vector3d& centre, double radius,
                 planning::OccupancyMap* map);

}  // namespace touchdown::evaluation
