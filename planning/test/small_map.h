// SPDX-License-Identifier: BSD-3-Clause
// Small maps shared by the tests of check, search, pairs and certificate.
#pragma once

#include "planning/test/planning_fixtures.h"
#include "touchdown/planning/certify/free_space.h"

namespace touchdown::planning {

inline OccupancyMapOptions SmallMap(double inflation) {
  OccupancyMapOptions options;
  options.size_log2 = {6, 6, 5};
  options.inflation_radius = inflation;
  return options;
}

/// The map without floor, ceiling or pad.
inline FreeSpace SpaceOf(const OccupancyMap& map) {
  FreeSpace space;
  space.map = &map;
  space.floor = -100.0;
  return space;
}

}  // namespace touchdown::planning
