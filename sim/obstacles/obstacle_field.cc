// SPDX-License-Identifier: BSD-3-Clause
// The field is small (tens of obstacles) and asked for distances only by checks and tests, so it is
// searched one by one; what runs often (depth camera, clearance) keeps its own faster structure.

#include "sim/obstacles/obstacle_field.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace touchdown::sim {

ObstacleField::ObstacleField(std::vector<Obstacle> obstacles) : obstacles_(std::move(obstacles)) {
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    Validate(obstacles_[i], "obstacle " + std::to_string(i));
  }
}

double ObstacleField::SignedDistance(const Eigen::Vector3d& p_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles_) {
    nearest = std::min(nearest, sim::SignedDistance(obstacle, p_W));
  }
  return nearest;
}

double ObstacleField::RayDistance(const Eigen::Vector3d& origin_W,
                                  const Eigen::Vector3d& direction_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles_) {
    nearest = std::min(nearest, sim::RayDistance(obstacle, origin_W, direction_W));
  }
  return nearest;
}

}  // namespace touchdown::sim
