// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/obstacles/obstacle.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// An obstacle with the key it came from, "obstacles.boxes[2]".
struct NamedObstacle {
  std::string key;
  sim::Obstacle obstacle;
};
using ObstacleList = std::vector<NamedObstacle>;

/// All obstacles of the scenario's world, list by list (obstacle_keys.h). Files are read once; their content is kept
/// for the next call, until they change.
/// @throws BadInput "<key>: <file>: <why>" for a file that gives no obstacles.
ObstacleList ObstaclesOf(const Scenario& scenario);

/// A hash of the files that the scenario's obstacles come from; "none" without any.
/// @throws BadInput as ObstaclesOf.
std::string WorldHash(const Scenario& scenario);

/// Horizontal distance between a point's box of half size `spread` and the part of an obstacle in the heights (z_lo,
/// z_hi) [m]. Infinite if there is no such part. For a mesh it is 0 if the mesh is within `within` of the box, else
/// infinite.
double HorizontalGap(const sim::Obstacle& obstacle, const Eigen::Vector2d& centre,
                     const Eigen::Vector2d& spread, double z_lo, double z_hi, double within);

}  // namespace touchdown::evaluation
