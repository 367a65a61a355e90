// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <Eigen/Core>

namespace touchdown::sim {

/// A ray that meets nothing.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Smallest s >= 0 at which origin + s * direction crosses the surface of a box, +infinity if it
/// never does. The box is centred at the origin with its sides along the axes. From inside: where
/// the ray leaves. `direction` has any length > 0. Does not allocate.
double RayBox(const Eigen::Vector3d& half_extents, const Eigen::Vector3d& origin,
              const Eigen::Vector3d& direction);

/// The same for a cylinder about the z axis, centred at the origin.
double RayCylinder(double radius, double half_height, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction);

/// The same for a ball about the origin.
double RayBall(double radius, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// A triangle by a corner and the sides from there.
struct Triangle {
  Eigen::Vector3d a, ab, ac;
};
/// The same for a triangle, from either side.
double RayTriangle(const Triangle& triangle, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction);

/// The same for a capsule: all points within `radius` of the segment from `a` to `b`, a != b.
double RayCapsule(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                  const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

}  // namespace touchdown::sim
