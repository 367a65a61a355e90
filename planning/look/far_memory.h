// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

/// What was ever seen to block the vehicle, far beyond the map's window: every third cell of each axis, 154 m x 154 m
/// around the vehicle and 9.6 m up, of cells of 0.1 m. What blocks is as thick as the hull, so nothing closed is open
/// here; a narrow passage may be missed.
class FarMemory {
 public:
  static constexpr int kApart = 3;  // cells

  /// Of maps as this one, from the floor [m] up.
  FarMemory(const OccupancyMap& map, double floor);

  /// Keeps what the window holds now. Does not allocate.
  void Keep(const OccupancyMap& map);

  /// Its cells are blocked, or not known to be.
  const OccupancyMap& map() const { return far_; }

 private:
  OccupancyMap far_;
};

}  // namespace touchdown::planning
