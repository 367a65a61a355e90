// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

/// What was seen closes every way.
struct NoWay {
  double since = 0.0;  ///< [s]
  int looks = 0;       ///< how often it had gone to look
};

/// The narrowest place of a way.
struct NarrowPlace {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< its middle [m]
  double width = 0.0;  ///< of the free cells between occupied ones there, at most about kWidest [m]

  static constexpr double kWidest = 3.0;
};

/// The least such width that a plan passes [m].
double LeastGap(const OccupancyMap& map);

/// The narrowest place of the widest way from here to there, through all that is not occupied, between floor and
/// ceiling [m]. An end beyond these or the window counts as at their border. Empty: there is none, or an end is occupied.
/// Takes about a second, and allocates: for when there is nothing else to do.
std::optional<NarrowPlace> FindNarrowPlace(const OccupancyMap& map, const Eigen::Vector3d& from,
                                           const Eigen::Vector3d& to, double floor, double ceiling);

}  // namespace touchdown::planning
