// SPDX-License-Identifier: BSD-3-Clause
// Greedy convex decomposition of free space, after S. Liu et al., "Planning Dynamically Feasible
// Trajectories for Quadrotors Using Safe Flight Corridors in 3-D Complex Environments", RA-L 2017,
// about a point instead of a segment and with planes that the optimiser may lean on: the term
// obstacle_pair is soft.

#include "touchdown/planning/corridor.h"

#include <algorithm>
#include <cmath>

#include "touchdown/planning/grid_search.h"

namespace touchdown::planning {

namespace {

using Eigen::Vector3d;

constexpr double kTouching = 1e-6;  // [m^2], no direction can be told

}  // namespace

Corridor::Corridor(double clearance, double margin) : beyond_(clearance - margin) {
  near_.reserve(1024);
}

/// Blocked cells within reach, as their points nearest to `point`. Of a row of cells along x the
/// nearest on each side stands for all.
void Corridor::Collect(const Vector3d& point, const FreeSpace& space) {
  near_.clear();
  const OccupancyMap& map = *space.map;
  const Vector3d half = Vector3d::Constant(0.5 * map.resolution());
  const int reach = static_cast<int>(std::ceil(kReach / map.resolution()));
  const CellIndex at = map.CellOf(point);
  const auto offer = [&](const CellIndex& cell) {
    const Vector3d centre = map.CentreOf(cell);
    const Vector3d p = point.cwiseMax(centre - half).cwiseMin(centre + half);
    const double distance2 = (p - point).squaredNorm();
    if (distance2 < kReach * kReach) near_.push_back({p, distance2});
  };
  for (int z = at.z() - reach; z <= at.z() + reach; ++z) {
    for (int y = at.y() - reach; y <= at.y() + reach; ++y) {
      const auto [below, above] = map.BlockedBeside({at.x(), y, z}, reach);
      if (below <= reach) offer({at.x() - below, y, z});
      if (above <= reach && above > 0) offer({at.x() + above, y, z});
    }
  }
}

void Corridor::Bind(int control_point, const Vector3d& wanted, const FreeSpace& space,
                    std::size_t most, std::vector<ObstaclePair>* pairs) {
  Vector3d point = wanted;
  if (space.Blocked(point)) {
    CellIndex cell = space.map->CellOf(point);
    if (!GridSearch::NearestFree(space, &cell)) return;
    point = space.map->CentreOf(cell);
  }
  Collect(point, space);
  for (std::size_t bound = 0; bound < most && !near_.empty(); ++bound) {
    const Near nearest =
        *std::min_element(near_.begin(), near_.end(),
                          [](const Near& a, const Near& b) { return a.distance2 < b.distance2; });
    if (nearest.distance2 < kTouching) return;
    const Vector3d v = (point - nearest.p).normalized();
    pairs->push_back({control_point, nearest.p, v});
    // What lies beyond the plane is kept off by it.
    std::erase_if(near_, [&](const Near& cell) { return (cell.p - nearest.p).dot(v) <= 1e-9; });
  }
  const double floor = space.OverPad(point) ? space.pad_floor : space.floor;
  if (point.z() - floor < kReach) {
    pairs->push_back({control_point, {point.x(), point.y(), floor - beyond_}, Vector3d::UnitZ()});
  }
  if (space.ceiling - point.z() < kReach) {
    pairs->push_back(
        {control_point, {point.x(), point.y(), space.ceiling + beyond_}, -Vector3d::UnitZ()});
  }
}

}  // namespace touchdown::planning
