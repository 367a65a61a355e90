// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/sim/path_drive.h"

namespace touchdown::sim {

/// Where the pad shall be when.
struct PadWaypoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< in W [m]
  double t = 0.0;                               ///< [s]
  int line = 0;                                 ///< of the file it came from, for messages
};

/// A drive past these points. Each corner is cut by a smooth turn, at most `acceleration` [m/s^2] and
/// `jerk` [m/s^3] across the path at the faster speed beside it; the pad is in the middle of the turn
/// when it should be at the point. Speeds change with at most the same acceleration and jerk along the
/// path. The pad stands before the first time and after the last, and between equal points.
/// Throws std::invalid_argument naming the line: fewer than two places, times that do not rise, a turn
/// by more than 150 degrees, or one that does not fit into half of the legs beside it.
PathDrive WaypointDrive(const std::vector<PadWaypoint>& waypoints, double acceleration,
                        double jerk);

}  // namespace touchdown::sim
