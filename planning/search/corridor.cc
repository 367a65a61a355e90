// SPDX-License-Identifier: BSD-3-Clause
// Greedy convex decomposition of free space, after S. Liu et al., "Planning Dynamically Feasible
// Trajectories for Quadrotors Using Safe Flight Corridors in 3-D Complex Environments", RA-L 2017.
// Here it is about a point instead of a segment, and the optimiser may lean on the planes: the term
// obstacle_pair is soft.

#include "planning/search/corridor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "planning/search/grid_search.h"

namespace touchdown::planning {

namespace {

using Eigen::Vector3d;

constexpr int kMostCells = 31;      // within reach along an axis: both sides fit into one word
constexpr double kTouching = 1e-6;  // [m^2], no direction can be told
constexpr double kRounding = 1e-9;  // of a cell's distance from a plane [m]

/// Where the cells of one axis are nearest to a coordinate of the point.
class NearestOnAxis {
 public:
  /// The cells [low, high), at most 2 kMostCells + 1.
  NearestOnAxis(double point, double resolution, int low, int high) : low_(low) {
    for (int cell = low; cell < high; ++cell) {
      const double centre = (cell + 0.5) * resolution, half = 0.5 * resolution;
      const double nearest = std::clamp(point, centre - half, centre + half);
      places_[static_cast<std::size_t>(cell - low)] = {nearest,
                                                       (nearest - point) * (nearest - point)};
    }
  }
  struct Place {
    double coordinate;
    double distance2;
  };
  const Place& operator[](int cell) const { return places_[static_cast<std::size_t>(cell - low_)]; }

 private:
  int low_;
  std::array<Place, 2 * kMostCells + 1> places_;
};

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
  const int reach = std::min(kMostCells, static_cast<int>(std::ceil(kReach / map.resolution())));
  const CellIndex at = map.CellOf(point);
  const CellIndex low = (at.array() - reach).max(map.origin().array());
  const CellIndex high = (at.array() + reach + 1).min((map.origin() + map.size()).array());
  if (low.x() > at.x() || high.x() <= at.x()) return;
  const auto places = [&](int axis) {
    return NearestOnAxis(point[axis], map.resolution(), low[axis], high[axis]);
  };
  const NearestOnAxis x = places(0), y = places(1), z = places(2);
  const int own = at.x() - low.x();
  CellIndex row = low;
  for (row.z() = low.z(); row.z() < high.z(); ++row.z()) {
    for (row.y() = low.y(); row.y() < high.y(); ++row.y()) {
      const double to_row2 = y[row.y()].distance2 + z[row.z()].distance2;
      if (to_row2 >= kReach * kReach) continue;
      const auto offer = [&](int cell) {
        const double distance2 = x[cell].distance2 + to_row2;
        if (distance2 >= kReach * kReach) return;
        near_.push_back(
            {{x[cell].coordinate, y[row.y()].coordinate, z[row.z()].coordinate}, distance2});
      };
      const std::uint64_t bits = space.ClosedRow(row, high.x() - low.x());
      const std::uint64_t above = bits >> own;  // from the point's own cell on
      const std::uint64_t below = bits ^ (above << own);
      if (above != 0) offer(at.x() + std::countr_zero(above));
      if (below != 0 && (above & 1u) == 0) {
        offer(low.x() + static_cast<int>(std::bit_width(below)) - 1);
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
    const Vector3d v = (point - nearest.p).normalized();
    pairs->push_back({control_point, nearest.p, v});
    if (++bound == most) break;
    // The plane also keeps off what lies beyond it.
    const double beyond = nearest.p.dot(v) + kRounding;
    std::erase_if(near_, [&](const Near& cell) { return cell.p.dot(v) <= beyond; });
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
