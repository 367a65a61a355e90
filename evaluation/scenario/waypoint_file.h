// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "sim/pad/waypoint_drive.h"

namespace touchdown::evaluation {

/// Reads CSV text of pad waypoints in W. Its first line names the columns. `t,x,y` has the time of each point [s].
/// `x,y,speed` has the speed from each point to the next one [m/s]; the first point is left at t = 0. Empty lines and
/// those that begin with # are skipped. docs/pad_motions.md has an example.
/// @throws std::invalid_argument "line N: <why>".
std::vector<sim::PadWaypoint> ReadWaypoints(std::istream& text);

/// The same of the file at `path`, of 16 MiB at most. @throws std::invalid_argument "<path>: <why>".
std::vector<sim::PadWaypoint> ReadWaypointFile(const std::string& path);

/// The points, exact to the last bit, as lines `t x y`. A record keeps this text of the file.
std::string WaypointText(const std::vector<sim::PadWaypoint>& points);

}  // namespace touchdown::evaluation
