// SPDX-License-Identifier: BSD-3-Clause
// Where the vehicle is it may be, and it may leave: the rule for cells that its grown hull is among at the start.
#pragma once

#include <algorithm>

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

inline constexpr double kNoNearer = 1e-6;  ///< rounding of a hull that comes no nearer to a cell [m]

/// Distance of a coordinate from the cell i.
inline double Gap(double x, int i, double resolution) {
  return std::max({0.0, i * resolution - x, x - (i + 1) * resolution});
}

/// Of a place from a cell [m].
inline double DistanceTo(const CellIndex& cell, const Eigen::Vector3d& p, double resolution) {
  return Eigen::Vector3d(Gap(p.x(), cell.x(), resolution), Gap(p.y(), cell.y(), resolution),
                         Gap(p.z(), cell.z(), resolution))
      .norm();
}

/// A ball of this radius [m] reached into the cell at the start, and at p is no nearer to it.
inline bool WasThere(const CellIndex& cell, const Eigen::Vector3d& start, const Eigen::Vector3d& p,
                     double radius, double resolution) {
  const double at_start = DistanceTo(cell, start, resolution);
  return at_start > 0.0 && at_start < radius &&
         DistanceTo(cell, p, resolution) >= at_start - kNoNearer;
}

}  // namespace touchdown::planning
