// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/obstacles/obstacle_field.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::evaluation {

/// Fills the map's window as if all of it had been seen. Every cell whose volume meets an obstacle
/// is occupied; all others are observed free. Cells that only touch an obstacle's surface do not
/// meet it, so that voxel columns on the map's lattice fill exactly their own cells.
void FillMap(const sim::ObstacleField& field, planning::OccupancyMap* map);

}  // namespace touchdown::evaluation
