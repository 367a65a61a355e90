// SPDX-License-Identifier: BSD-3-Clause
// Obstacles made of many small pieces. They exist for maps, distances and rays, not as geoms of a
// MuJoCo world.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace touchdown::sim {

/// Square columns side by side on a lattice, each with its own height: a pillar as a voxel map knows
/// it.
struct VoxelColumns {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< lowest corner of column (0, 0), in W [m]
  double cell = 0.1;                                 ///< side of a column [m], > 0
  int count_x = 1;                                   ///< columns along x, in [1, 1000]
  int count_y = 1;                                   ///< columns along y, in [1, 1000]
  std::vector<double> heights = {1.0};  ///< [y * count_x + x], above the corner [m]; 0: none there
};

/// Upright elliptic hoop: a closed chain of kSides capsules whose ends lie on the ellipse.
struct Ring {
  static constexpr int kSides = 36;

  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< in W [m]
  double half_width = 0.6;                           ///< horizontal half axis [m], > 0
  double half_height = 0.9;                          ///< vertical half axis [m], > 0
  double tube_radius = 0.05;                         ///< [m], > 0
  double yaw = 0.0;                                  ///< heading of its normal [rad]

  /// End of side `i` on the ellipse, in W; side i runs from Corner(i) to Corner(i + 1).
  Eigen::Vector3d Corner(int i) const;
};

/// Distance to the nearest piece [m], negative inside: exact outside, and inside exact for the
/// deepest piece. Does not allocate.
double DistanceTo(const VoxelColumns& columns, const Eigen::Vector3d& p_W);
double DistanceTo(const Ring& ring, const Eigen::Vector3d& p_W);

/// Smallest s >= 0 at which origin + s * direction crosses the surface of any piece, +infinity if
/// it never does. Does not allocate.
double RayTo(const VoxelColumns& columns, const Eigen::Vector3d& origin_W,
             const Eigen::Vector3d& direction_W);
double RayTo(const Ring& ring, const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W);

/// Distance from the point to the segment from `a` to `b`.
double SegmentDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& p);

}  // namespace touchdown::sim
