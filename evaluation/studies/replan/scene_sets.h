// SPDX-License-Identifier: BSD-3-Clause
// Sets of single replanning steps: the question and the world.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "evaluation/studies/replan/forest_scene.h"
#include "sim/base/random_stream.h"
#include "sim/obstacles/obstacle_field.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::evaluation {

/// The planning question in a world, before there is a map of it. All vectors in W.
struct SceneSketch {
  sim::ObstacleField field;
  double height = 3.0;                               ///< of the world [m]
  planning::SplineState start;                       ///< at t = 0
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< where the end is when it is met [m]
  bool target_moves = true;  ///< to the nearest free cell, if it is in an obstacle
  Eigen::Vector3d v_end = Eigen::Vector3d::Zero();    ///< of the end [m/s]
  Eigen::Vector3d passing = Eigen::Vector3d::Zero();  ///< velocity relative to it at arrival [m/s]
};

/// A set of scenes. `draw` draws from the stream; the kind gives limits and inflation.
struct SceneSet {
  const char* name;
  const char* what;  ///< one line
  SceneSketch (*draw)(const SceneOptions& options, sim::RandomStream& stream);
};

/// In the order of the report.
const std::vector<SceneSet>& SceneSets();
std::vector<std::string> SceneSetNames();
/// Throws std::invalid_argument naming the sets.
const SceneSet& SceneSetNamed(const std::string& name);

}  // namespace touchdown::evaluation
