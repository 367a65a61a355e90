// SPDX-License-Identifier: BSD-3-Clause
// A start, a goal and a random forest between them: the scenes that EGO-Planner was measured in.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/base/random_stream.h"
#include "sim/obstacles/obstacle_field.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/planning/spline/limits.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::evaluation {

/// A kind of scenes: forest, limits and inflation.
struct SceneKind {
  std::string name;    ///< A, B, C, D
  std::string forest;  ///< as sim::ForestOfKind
  planning::Limits limits;
  double inflation = 0.1;  ///< of the map [m]
};

/// The kinds A to D of the published measurements. Throws std::invalid_argument naming them.
const SceneKind& SceneKindNamed(const std::string& name);
const std::vector<SceneKind>& SceneKinds();

/// What is drawn.
struct SceneOptions {
  SceneKind kind;
  std::string set = "crossing";  ///< of replanning steps (scene_sets.h)
  double horizon = 7.5;          ///< start to target [m]
  double resolution = 0.1;       ///< of the map [m]
  double density = 0.0;          ///< pillars per square metre; 0: the kind's own
  std::uint64_t seed = 1;
};

/// A vehicle in flight to a goal. The caller decides which part of the forest it knows.
struct ForestScene {
  planning::SplineState start;                       ///< in W
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();  ///< unit vector to the goal, level
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();    ///< in W [m]
  double height = 3.0;                               ///< of the forest [m]
  sim::ObstacleField field;
};

/// Floor and ceiling of every flight through a forest [m].
inline constexpr double kForestFloor = 0.2;
inline constexpr double kForestCeiling = 2.5;

/// A ball that replaces a point for distances to obstacles; its radius [m].
inline constexpr double kPointRadius = 1e-4;
estimation::VehicleModel PointVehicle();

/// Scenes whose start is blocked are drawn again: this many draws at most before that is an error.
inline constexpr int kForestSceneDraws = 100;

/// The random stream of draw number `draw` of scene `index`.
sim::RandomStream SceneStream(const SceneOptions& options, int index, int draw);

/// Draws a scene. The start is at 1 m height with up to 0.8 of the speed limit, within 0.4 rad of the direction to the
/// goal. The goal is 11 / 7.5 horizons ahead. No pillar is within 2 m of either. The stream can be drawn from further.
/// Throws std::invalid_argument for an option out of range.
ForestScene DrawForestScene(const SceneOptions& options, sim::RandomStream* stream);

}  // namespace touchdown::evaluation
