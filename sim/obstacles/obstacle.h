// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <variant>

#include <Eigen/Core>

#include "sim/obstacles/compound_shapes.h"

namespace touchdown::sim {

/// Box that stands upright: its z axis is the world's, its x axis has the heading `yaw`.
struct Box {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();             ///< in W [m]
  Eigen::Vector3d half_extents = Eigen::Vector3d::Constant(1);  ///< along its own axes [m], > 0
  double yaw = 0.0;                                             ///< [rad]
};

/// Cylinder whose axis is vertical.
struct Cylinder {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< middle of the axis, in W [m]
  double radius = 0.5;                               ///< [m], > 0
  double height = 2.0;                               ///< whole height [m], > 0
};

/// One solid thing that does not move.
using Obstacle = std::variant<Box, Cylinder, VoxelColumns, Ring>;

/// Axis-aligned bounds in W [m].
struct Bounds {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
};

/// Throws std::invalid_argument, naming the obstacle as `name`, the value and the allowed range, if
/// a size is not in (0, 1000] m or a number is not finite.
void Validate(const Obstacle& obstacle, const std::string& name);

/// Throws std::invalid_argument, naming the obstacle as `name` and what needs it as `user`, unless it
/// is a box or a cylinder: voxel columns and rings are no geoms of a MuJoCo world, nor of the
/// checkers and cameras that work beside one.
void CheckGeom(const Obstacle& obstacle, const std::string& name, const std::string& user);

/// Distance from the point `p_W` to the surface [m], negative inside. Exact, but for the inside of
/// voxel columns and rings (see there). Does not allocate.
double SignedDistance(const Obstacle& obstacle, const Eigen::Vector3d& p_W);

/// Smallest s >= 0 at which origin + s * direction crosses the surface, +infinity if it never does.
/// `direction` has any length > 0; s is in units of it. A ray from inside returns where it leaves
/// the shape, or the piece of it that it leaves first.
/// Does not allocate.
double RayDistance(const Obstacle& obstacle, const Eigen::Vector3d& origin_W,
                   const Eigen::Vector3d& direction_W);

/// Tight axis-aligned bounds.
Bounds BoundsOf(const Obstacle& obstacle);

}  // namespace touchdown::sim
