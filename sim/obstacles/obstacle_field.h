// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/bounds_tree.h"
#include "sim/obstacles/obstacle.h"

namespace touchdown::sim {

/// All obstacles of a world, each valid. The ground (z = 0) and the pad are not in it. A value type. Rays, distances,
/// touches, pictures and maps are made from this one list. A tree searches it, so thousands of obstacles are no burden.
class ObstacleField {
 public:
  ObstacleField() = default;

  /// Throws std::invalid_argument naming "obstacle <index>", the value and the allowed range.
  explicit ObstacleField(std::vector<Obstacle> obstacles);

  const std::vector<Obstacle>& obstacles() const { return obstacles_; }
  std::size_t size() const { return obstacles_.size(); }
  bool empty() const { return obstacles_.empty(); }

  /// Distance from `p_W` to the nearest surface [m], negative inside; +infinity in an empty field.
  double SignedDistance(const Eigen::Vector3d& p_W) const;

  /// Nearest crossing over all obstacles, as sim::RayDistance.
  double RayDistance(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W) const;
  /// ... of one of them.
  double RayDistance(std::size_t obstacle, const Eigen::Vector3d& origin_W,
                     const Eigen::Vector3d& direction_W) const;

  /// Of the obstacles' bounds.
  const BoundsTree& tree() const { return tree_; }

 private:
  std::vector<Obstacle> obstacles_;
  std::vector<TurnedBox> boxes_;  ///< those among the obstacles
  std::vector<int> box_of_;       ///< index in boxes_; -1: another kind
  BoundsTree tree_;
};

}  // namespace touchdown::sim
