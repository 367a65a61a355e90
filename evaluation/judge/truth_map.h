// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::evaluation {

/// Marks all cells of the window as observed free, except occupied cells and those that an obstacle may reach into.
/// This is the map of a flight whose camera sees everything. For studies of the cost of looking. `drift_W` is the error
/// of the frame that the map lives in [m].
void ObserveTruth(const sim::ObstacleField& obstacles, const Eigen::Vector3d& drift_W,
                  planning::OccupancyMap* map);

}  // namespace touchdown::evaluation
