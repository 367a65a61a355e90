// SPDX-License-Identifier: BSD-3-Clause
// First plan calls of the EGO-Planner baseline in the scenes in which the released program was
// measured.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "evaluation/studies/replan/forest_scene.h"
#include "planning/baselines/ego/ego_options.h"

namespace touchdown::evaluation {

/// The result of one first plan call. The figures of the curve are NaN without one.
struct EgoSceneResult {
  planning::EgoStatus status = planning::EgoStatus::kInvalidInput;
  int control_points = 0;
  int iterations = 0;  ///< of L-BFGS, all runs of the rebound optimisation
  int evaluations = 0;
  int runs = 0;
  int searches = 0;  ///< A* calls
  bool refined = false;
  double length = 0.0;            ///< [m]
  double duration = 0.0;          ///< [s]
  double jerk = 0.0;              ///< integral of squared jerk [m^2/s^5]
  double max_speed = 0.0;         ///< norm [m/s]
  double max_acceleration = 0.0;  ///< norm [m/s^2]
};

/// Makes the first plan call in each of `scenes` forest scenes of the kind. Obstacles within 12 m of the start are
/// known; the map is the published one. `report` gets the progress. The same seed gives the same results. @throws
/// std::invalid_argument if scenes < 1.
std::vector<EgoSceneResult> RunEgoScenes(const SceneKind& kind, int scenes, std::uint64_t seed,
                                         const std::function<void(int done, int all)>& report);

}  // namespace touchdown::evaluation
