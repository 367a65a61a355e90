// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <variant>

#include <Eigen/Core>

#include "sim/obstacles/bounds_tree.h"
#include "sim/obstacles/compound_shapes.h"
#include "sim/obstacles/triangle_mesh.h"

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

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< in W [m]
  double radius = 0.5;                               ///< [m], > 0
};

/// Any other solid, by its surface. Copies share it.
struct Mesh {
  std::shared_ptr<const TriangleMesh> surface;  ///< never nullptr
};

/// One solid thing that does not move.
using Obstacle = std::variant<Box, Cylinder, Sphere, Mesh, VoxelColumns, Ring>;

/// Throws std::invalid_argument if a size is not in (0, 1000] m or a number is not finite. The
/// message names the obstacle as `name`, the value and the allowed range.
void Validate(const Obstacle& obstacle, const std::string& name);

/// Throws std::invalid_argument if the obstacle is a group of voxel columns or a ring. These are for maps and planners
/// only; they are neither rendered nor touched. The message names the obstacle as `name` and what needs it as `user`.
void CheckGeom(const Obstacle& obstacle, const std::string& name, const std::string& user);

/// Distance from the point `p_W` to the surface [m], negative inside. Exact, except inside voxel
/// columns and rings (see there). Does not allocate.
double SignedDistance(const Obstacle& obstacle, const Eigen::Vector3d& p_W);

/// Smallest s >= 0 at which origin + s * direction crosses the surface, +infinity if it never does.
/// `direction` has any length > 0; s is in units of it. A ray from inside returns where it leaves
/// the shape, or the piece of it that it leaves first.
/// Does not allocate.
double RayDistance(const Obstacle& obstacle, const Eigen::Vector3d& origin_W,
                   const Eigen::Vector3d& direction_W);

/// Tight axis-aligned bounds.
Bounds BoundsOf(const Obstacle& obstacle);

/// A box prepared for many calls; it gives what SignedDistance and RayDistance give.
class TurnedBox {
 public:
  explicit TurnedBox(const Box& box);
  double SignedDistance(const Eigen::Vector3d& p_W) const;
  double RayDistance(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W) const;

 private:
  Eigen::Vector3d ToBox(const Eigen::Vector3d& v_W) const;

  Eigen::Vector3d center_, half_extents_;
  double cos_, sin_;  // of the yaw
};

}  // namespace touchdown::sim
