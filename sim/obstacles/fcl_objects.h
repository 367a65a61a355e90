// SPDX-License-Identifier: BSD-3-Clause
// FCL's headers are heavy. Only the few sources that use FCL include this.
#pragma once

#include <memory>
#include <vector>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision_object.h>

#include "sim/obstacles/obstacle_field.h"

namespace touchdown::sim {

using FclObject = fcl::CollisionObjectd;

/// A field's obstacles in FCL's dynamic tree of bounds. Each object knows the obstacle that it belongs to.
class FclObstacles {
 public:
  explicit FclObstacles(const ObstacleField& obstacles);
  FclObstacles(FclObstacles&&) = delete;

  const fcl::DynamicAABBTreeCollisionManagerd& tree() const { return tree_; }

 private:
  std::vector<int> indices_;  // what the objects' user data points to
  std::vector<std::unique_ptr<FclObject>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd tree_;
};

/// A surface by its triangles. Its bounds are computed here, once: it may be shared between threads.
std::shared_ptr<fcl::CollisionGeometryd> FclSurface(const std::vector<Eigen::Vector3d>& corners,
                                                    const std::vector<Eigen::Vector3i>& triangles);

/// The index of the obstacle of the pair; one of the two objects is an obstacle's.
int ObstacleOf(const FclObject& a, const FclObject& b);

}  // namespace touchdown::sim
