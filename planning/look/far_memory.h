// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

/// What was ever seen to block the vehicle, far beyond the map's window: a cell every 0.3 m, 154 m x 154 m around the
/// vehicle and 9.6 m up. What blocks is as thick as the hull, so nothing closed is open here; a narrow passage may be
/// missed.
class FarMemory {
 public:
  /// Of maps as this one, from the floor [m] up.
  FarMemory(const OccupancyMap& map, double floor);

  /// Keeps what the window holds now. Does not allocate.
  void Keep(const OccupancyMap& map);

  /// Its cells are blocked, or not known to be.
  const OccupancyMap& map() const { return far_; }

 private:
  int apart_;  // cells of the map
  OccupancyMap far_;
};

}  // namespace touchdown::planning
