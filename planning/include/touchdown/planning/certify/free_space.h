// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include "touchdown/planning/certify/unseen_zone.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

/// Where a plan may go: the inflated map, a floor and a ceiling for the body's origin, and the
/// strip above the moving pad with its own floor. Unknown space counts as free, except where
/// `unseen` closes it. A view of the map, cheap to make anew for every replanning step.
struct FreeSpace {
  const OccupancyMap* map = nullptr;
  const UnseenZone* unseen = nullptr;                        ///< closed as well; nullptr: nothing
  double floor = 0.0;                                        ///< [m]
  double ceiling = std::numeric_limits<double>::infinity();  ///< [m]
  Eigen::Vector2d pad_from = Eigen::Vector2d::Zero();  ///< strip's axis: pad at start and arrival
  Eigen::Vector2d pad_to = Eigen::Vector2d::Zero();
  double pad_radius = 0.0;  ///< strip's half width [m]; 0: none
  double pad_floor = 0.0;   ///< floor within the strip [m]

  bool OverPad(const Eigen::Vector3d& p_W) const {
    if (pad_radius <= 0.0) return false;
    const Eigen::Vector2d axis = pad_to - pad_from;
    const Eigen::Vector2d offset = p_W.head<2>() - pad_from;
    const double length2 = axis.squaredNorm();
    const double s = length2 > 0.0 ? std::clamp(offset.dot(axis) / length2, 0.0, 1.0) : 0.0;
    return (offset - s * axis).squaredNorm() <= pad_radius * pad_radius;
  }

  double FloorAt(const Eigen::Vector3d& p_W) const { return OverPad(p_W) ? pad_floor : floor; }

  /// A cell is free if all of it is between floor and ceiling.
  bool Blocked(const CellIndex& cell) const {
    if (Closed(cell)) return true;
    const Eigen::Vector3d centre = map->CentreOf(cell);
    const double half = 0.5 * map->resolution();
    return centre.z() + half > ceiling + kLevelRounding ||
           centre.z() - half < FloorAt(centre) - kLevelRounding;
  }
  /// A place is free if its cell does not block and it is itself between floor and ceiling.
  bool Blocked(const Eigen::Vector3d& p_W) const {
    return !map->HasIndex(p_W) || Closed(map->CellOf(p_W)) || OffLevel(p_W);
  }
  /// By an obstacle, or because it was not seen.
  bool Closed(const CellIndex& cell) const {
    return map->IsBlocked(cell) || (unseen != nullptr && unseen->Holds(cell));
  }
  /// The same as bits of cells along x; see OccupancyMap::BlockedRow.
  std::uint64_t ClosedRow(const CellIndex& first, int count) const {
    const std::uint64_t row = map->BlockedRow(first, count);
    return unseen != nullptr ? row | unseen->Row(first, count) : row;
  }
  bool OffLevel(const Eigen::Vector3d& p_W) const {
    return p_W.z() > ceiling + kLevelRounding || p_W.z() < FloorAt(p_W) - kLevelRounding;
  }

  static constexpr double kLevelRounding = 1e-6;  ///< of sums of control points [m]
};

}  // namespace touchdown::planning
