// SPDX-License-Identifier: BSD-3-Clause
#include "sim/obstacles/obstacle_field.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace touchdown::sim {

ObstacleField::ObstacleField(std::vector<Obstacle> obstacles) : obstacles_(std::move(obstacles)) {
  std::vector<Bounds> bounds;
  bounds.reserve(obstacles_.size());
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    Validate(obstacles_[i], "obstacle " + std::to_string(i));
    bounds.push_back(BoundsOf(obstacles_[i]));
    const auto* const box = std::get_if<Box>(&obstacles_[i]);
    box_of_.push_back(box != nullptr ? static_cast<int>(boxes_.size()) : -1);
    if (box != nullptr) boxes_.emplace_back(*box);
  }
  tree_ = BoundsTree(bounds);
}

double ObstacleField::SignedDistance(const Eigen::Vector3d& p_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  tree_.Near(p_W, &nearest, [&](int i) {
    nearest = std::min(nearest,
                       sim::SignedDistance(obstacles_[static_cast<std::size_t>(i)], p_W));
  });
  return nearest;
}

double ObstacleField::RayDistance(const Eigen::Vector3d& origin_W,
                                  const Eigen::Vector3d& direction_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  tree_.Along(origin_W, direction_W, &nearest, [&](int i) {
    nearest = std::min(nearest, RayDistance(static_cast<std::size_t>(i), origin_W, direction_W));
  });
  return nearest;
}

double ObstacleField::RayDistance(std::size_t obstacle, const Eigen::Vector3d& origin_W,
                                  const Eigen::Vector3d& direction_W) const {
  const int box = box_of_[obstacle];
  return box >= 0 ? boxes_[static_cast<std::size_t>(box)].RayDistance(origin_W, direction_W)
                  : sim::RayDistance(obstacles_[obstacle], origin_W, direction_W);
}

}  // namespace touchdown::sim
