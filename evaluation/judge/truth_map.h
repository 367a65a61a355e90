// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::evaluation {

/// Takes every cell of the window as observed free that no obstacle reaches into, but for those that block: what
/// a flight would be if its camera saw everything. For studies of what looking costs. `drift_W` is the error
/// of the frame that the map lives in [m].
void ObserveTruth(const sim::ObstacleField& obstacles, const Eigen::Vector3d& drift_W,
                  planning::OccupancyMap* map);

}  // namespace touchdown::evaluation
