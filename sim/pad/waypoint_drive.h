// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/pad/path_drive.h"

namespace touchdown::sim {

/// Where the pad should be, and when.
struct PadWaypoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< in W [m]
  double t = 0.0;                               ///< [s]
  int line = 0;                                 ///< of the file it came from, for messages
};

/// Points closer than this are one place [m].
inline constexpr double kSamePlace = 1e-3;

/// A drive past these points. Each corner is cut by a smooth turn. Across the path it has at most `acceleration`
/// [m/s^2] and `jerk` [m/s^3] at the faster speed beside the corner. Speeds change with at most the same acceleration
/// and jerk along the path. With w = Pace::SmoothingFor(fastest leg, acceleration, jerk) every change takes 3 w. The
/// middle of the change is when the pad should be at the point. Where the speed stays, the pad is at the point (or in
/// the middle of the turn there) at its time. Where the speed changes by d, it is 13/64 w d farther on. It stands from
/// 1.5 w after it should arrive to 1.5 w before it should leave. It also stands before the first time, after the last,
/// and between equal points.
/// @throws std::invalid_argument naming the line: fewer than two places; times that do not rise; a leg faster than 20
/// m/s; a stop shorter than 3 w; a turn by more than 150 degrees, or one that does not fit into half of the legs beside
/// it.
PathDrive WaypointDrive(const std::vector<PadWaypoint>& waypoints, double acceleration,
                        double jerk);

}  // namespace touchdown::sim
