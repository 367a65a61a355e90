// SPDX-License-Identifier: BSD-3-Clause
// A path's way around an obstacle is the side on which it passes. The side is taken where the path
// crosses the plane across the curve that is blocked there.

#include "planning/search/barrier.h"

#include <cmath>
#include <limits>

namespace touchdown::planning {

namespace {

constexpr double kStill = 1e-3;   // a slower curve, or a shorter path, has no direction [m/s, m]
constexpr double kNoSide = 1e-2;  // from the curve to the path [m]
constexpr double kCosHalf = 0.1;  // a little less than half of the plane

}  // namespace

std::optional<Barrier> ClosePath(std::span<const Eigen::Vector3d> path, const FlatState& through) {
  Barrier barrier;
  barrier.p = through.p_WB;
  if (path.empty()) return std::nullopt;
  barrier.normal = through.v_WB.norm() > kStill ? through.v_WB : path.back() - path.front();
  if (!(barrier.normal.norm() > kStill)) return std::nullopt;
  barrier.normal.normalize();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : path) {
    const double along = DistanceAlong(barrier, p);
    if (std::abs(along) >= nearest) continue;
    nearest = std::abs(along);
    barrier.side = p - barrier.p - along * barrier.normal;
  }
  if (!(barrier.side.norm() > kNoSide)) return std::nullopt;
  barrier.side.normalize();
  return barrier;
}

bool Closes(const Barrier& barrier, const Eigen::Vector3d& centre, double resolution) {
  const double along = DistanceAlong(barrier, centre);
  if (std::abs(along) > kBarrierThickness * resolution) return false;
  const Eigen::Vector3d across = centre - barrier.p - along * barrier.normal;
  return across.dot(barrier.side) > kCosHalf * across.norm();
}

}  // namespace touchdown::planning
