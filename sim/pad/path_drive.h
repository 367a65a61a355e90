// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "touchdown/sim/pad/curvature_chain.h"
#include "touchdown/sim/pad/pace.h"

namespace touchdown::sim {

/// A path and how it is driven.
struct PathDrive {
  CurvatureChain path;
  Pace pace;
};

/// Periodic, at every t: `speed` for `go_time`, standing for `stop_time`. The arc length is 0 at t = 0, where a change
/// to `speed` has just ended. At `go_time` the change to standing has just ended. Acceleration is at most
/// `acceleration`. Times include half of each change of speed [s].
Pace StopAndGoPace(double speed, double go_time, double stop_time, double acceleration);

/// Alike, forwards at `speed` for `go_time` and backwards as long.
Pace ReversingPace(double speed, double go_time, double acceleration);

/// What a random drive keeps to.
struct RandomDriveLimits {
  double speed = 0.8;         ///< [m/s]
  double turn_rate = 0.25;    ///< [rad/s]
  double acceleration = 0.5;  ///< [m/s^2]
  double jerk = 1.0;          ///< of the motion, in norm [m/s^3]
};

/// Turns and speeds drawn from `seed`. The turns are arcs of random curvature, each as long as 2 to 8 s at full speed.
/// The speeds are between 0.3 of the full one and the full one, or in one case of five zero, for 3 to 8 s each. They
/// are drawn from t = 0 to `until` [s]. The drive is the same whatever `until` is. Before 0 it comes straight at its
/// first speed.
PathDrive RandomDrive(const Eigen::Vector2d& start, double heading, const RandomDriveLimits& limits,
                      std::uint64_t seed, double until);

}  // namespace touchdown::sim
