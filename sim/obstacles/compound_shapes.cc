// SPDX-License-Identifier: BSD-3-Clause
// Piece by piece: a column is an axis-aligned box, a side of a ring a capsule. These shapes are
// used while scenes are drawn and checked, never in a flight. So there is no search structure.

#include "sim/obstacles/compound_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/obstacles/ray_intersection.h"

namespace touchdown::sim {
namespace {

/// Calls visit(centre, half_extents) for every column that stands.
template <class Visit>
void ForEachColumn(const VoxelColumns& columns, Visit&& visit) {
  for (int y = 0; y < columns.count_y; ++y) {
    for (int x = 0; x < columns.count_x; ++x) {
      const double height = columns.heights[static_cast<std::size_t>(y * columns.count_x + x)];
      if (height <= 0.0) continue;
      const Eigen::Vector3d half(0.5 * columns.cell, 0.5 * columns.cell, 0.5 * height);
      visit(columns.corner + Eigen::Vector3d(x * columns.cell, y * columns.cell, 0.0) + half, half);
    }
  }
}

}  // namespace

Eigen::Vector3d Ring::Corner(int i) const {
  const double angle = 2.0 * std::numbers::pi * (i % kSides) / kSides;
  const double across = half_width * std::cos(angle);
  return center + Eigen::Vector3d(-across * std::sin(yaw), across * std::cos(yaw),
                                  half_height * std::sin(angle));
}

double SegmentDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + s * along - p).norm();
}

double DistanceTo(const VoxelColumns& columns, const Eigen::Vector3d& p_W) {
  double nearest = kInfinity;
  ForEachColumn(columns, [&](const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
    const Eigen::Vector3d q = (p_W - center).cwiseAbs() - half;
    nearest = std::min(nearest, q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0));
  });
  return nearest;
}

double DistanceTo(const Ring& ring, const Eigen::Vector3d& p_W) {
  double nearest = kInfinity;
  for (int i = 0; i < Ring::kSides; ++i) {
    nearest = std::min(nearest, SegmentDistance(ring.Corner(i), ring.Corner(i + 1), p_W));
  }
  return nearest - ring.tube_radius;
}

double RayTo(const VoxelColumns& columns, const Eigen::Vector3d& origin_W,
             const Eigen::Vector3d& direction_W) {
  double nearest = kInfinity;
  ForEachColumn(columns, [&](const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
    nearest = std::min(nearest, RayBox(half, origin_W - center, direction_W));
  });
  return nearest;
}

double RayTo(const Ring& ring, const Eigen::Vector3d& origin_W,
             const Eigen::Vector3d& direction_W) {
  double nearest = kInfinity;
  for (int i = 0; i < Ring::kSides; ++i) {
    nearest = std::min(nearest, RayCapsule(ring.Corner(i), ring.Corner(i + 1), ring.tube_radius,
                                           origin_W, direction_W));
  }
  return nearest;
}

}  // namespace touchdown::sim
