// SPDX-License-Identifier: BSD-3-Clause
// Greedy convex decomposition of free space, after S. Liu et al., "Planning Dynamically Feasible
// Trajectories for Quadrotors Using Safe Flight Corridors in 3-D Complex Environments", RA-L 2017,
// about a point instead of a segment and with planes that the optimiser may lean on: the term
// obstacle_pair is soft.

#include "touchdown/planning/corridor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "touchdown/planning/grid_search.h"

namespace touchdown::planning {

namespace {

using Eigen::Vector3d;

constexpr int kMostCells = 31;      // within reach along an axis: both sides fit into one word
constexpr double kTouching = 1e-6;  // [m^2], no direction can be told

}  // namespace

Corridor::Corridor(double clearance, double margin) : beyond_(clearance - margin) {
  constexpr std::size_t kRows = (2 * kMostCells + 1) * (2 * kMostCells + 1);
  near_.reserve(2 * kRows);
}

/// Blocked cells within reach, as their points nearest to `point`. Of a row of cells along x the
/// nearest on each side stands for all.
void Corridor::Collect(const Vector3d& point, const FreeSpace& space) {
  near_.clear();
  const OccupancyMap& map = *space.map;
  const Vector3d half = Vector3d::Constant(0.5 * map.resolution());
  const int reach = std::min(kMostCells, static_cast<int>(std::ceil(kReach / map.resolution())));
  const CellIndex at = map.CellOf(point);
  const auto offer = [&](const CellIndex& cell) {
    const Vector3d centre = map.CentreOf(cell);
    const Vector3d p = point.cwiseMax(centre - half).cwiseMin(centre + half);
    const double distance2 = (p - point).squaredNorm();
    if (distance2 < kReach * kReach) near_.push_back({p, distance2});
  };
  const auto gap = [&](int cells) { return std::max(0, std::abs(cells) - 1) * map.resolution(); };
  const CellBox window = {map.origin(), map.origin() + map.size()};
  const int from = std::max(at.x() - reach, window.low.x());
  const int to = std::min(at.x() + reach + 1, window.high.x());
  if (from > at.x() || to <= at.x()) return;
  for (int z = std::max(at.z() - reach, window.low.z());
       z < std::min(at.z() + reach + 1, window.high.z()); ++z) {
    for (int y = std::max(at.y() - reach, window.low.y());
         y < std::min(at.y() + reach + 1, window.high.y()); ++y) {
      const double gap_y = gap(y - at.y()), gap_z = gap(z - at.z());
      if (gap_y * gap_y + gap_z * gap_z >= kReach * kReach) continue;
      const std::uint64_t row = map.BlockedRow({from, y, z}, to - from);
      const std::uint64_t above = row >> (at.x() - from);  // from the point's own cell on
      const std::uint64_t below = row ^ (above << (at.x() - from));
      if (above != 0) offer({at.x() + std::countr_zero(above), y, z});
      if (below != 0 && (above & 1u) == 0) {
        offer({from + static_cast<int>(std::bit_width(below)) - 1, y, z});
      }
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
  for (std::size_t bound = 0; bound < most && !near_.empty();) {
    const auto at = std::min_element(near_.begin(), near_.end(), [](const Near& a, const Near& b) {
      return a.distance2 < b.distance2;
    });
    const Near nearest = *at;
    if (nearest.distance2 < kTouching) {
      near_.erase(at);
      continue;
    }
    ++bound;
    const Vector3d v = (point - nearest.p).normalized();
    pairs->push_back({control_point, nearest.p, v});
    // What lies beyond the plane is kept off by it.
    std::erase_if(near_, [&](const Near& cell) { return (cell.p - nearest.p).dot(v) <= 1e-9; });
  }
  const double floor = space.FloorAt(point);
  if (point.z() - floor < kReach) {
    pairs->push_back({control_point, {point.x(), point.y(), floor - beyond_}, Vector3d::UnitZ()});
  }
  if (space.ceiling - point.z() < kReach) {
    pairs->push_back(
        {control_point, {point.x(), point.y(), space.ceiling + beyond_}, -Vector3d::UnitZ()});
  }
}

}  // namespace touchdown::planning
