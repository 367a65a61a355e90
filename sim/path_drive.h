// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "touchdown/sim/curvature_chain.h"
#include "touchdown/sim/pace.h"

namespace touchdown::sim {

/// A path and how it is driven.
struct PathDrive {
  CurvatureChain path;
  Pace pace;
};

/// Paces cover times from -10 s to this after the start [s]; after that the speed stays.
inline constexpr double kPaceHorizon = 700.0;

/// Speed is 0 for `stop_time`, `speed` for `go_time`, and so on; begins driving at t = 0, where the way
/// is 0. Acceleration is at most `acceleration`. Times include half of each change of speed [s].
Pace StopAndGoPace(double speed, double go_time, double stop_time, double acceleration);

/// Forwards at `speed` for `go_time`, backwards as long, and so on.
Pace ReversingPace(double speed, double go_time, double acceleration);

/// What a random drive keeps to.
struct RandomDriveLimits {
  double speed = 0.8;         ///< [m/s]
  double turn_rate = 0.25;    ///< [rad/s]
  double acceleration = 0.5;  ///< [m/s^2]
  double jerk = 1.0;          ///< of the motion, in norm [m/s^3]
};

/// Turns and speeds drawn from `seed`: arcs of random curvature, each for 2 to 8 s at full speed, and
/// speeds between 0.3 of the full one and all of it, or in one case of five a stop, for 3 to 8 s each.
PathDrive RandomDrive(const Eigen::Vector2d& start, double heading, const RandomDriveLimits& limits,
                      std::uint64_t seed);

}  // namespace touchdown::sim
