// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace touchdown::planning {

/// Limits on the norms of velocity and acceleration, and on the body rate that they require.
struct Limits {
  double speed = 3.0;         ///< [m/s]
  double acceleration = 6.0;  ///< [m/s^2]
  /// Factor on the acceleration for stops in observed space: in wind the tracking law tilts farther
  /// for them than plans do.
  double braking_factor = 1.0;
  /// On DerivativeBounds::body_rate [rad/s]. If the thrust axis turns faster, the attitude cannot follow, and overshoots
  /// far.
  double body_rate = 4.0;
  /// A steady force over the mass that acts beside gravity: the thrust axis leans against it too [m/s^2].
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();
};

/// How fast a start beyond a limit must come back to it. The speed may be |v0| - kSpeedShare amax
/// (t - kLag): a deceleration takes time to build up. The acceleration may be |a0| (1 -
/// kAccelerationDecay t). Neither profile falls below the limit.
struct RecoveryProfile {
  static constexpr double kLag = 0.3;  ///< [s]
  static constexpr double kSpeedShare = 0.5;
  static constexpr double kAccelerationDecay = 2.0;  ///< [1/s]
};

/// A plan's end may move at this share of the speed limit. Beyond, hard limits have no interior, or
/// almost none.
inline constexpr double kFastestEndShare = 0.9;

/// What thrust, tilt and visibility terms know of the vehicle.
struct VehicleFacts {
  double thrust_min = 2.0;           ///< least thrust over mass [m/s^2]
  double thrust_max = 23.0;          ///< greatest thrust over mass [m/s^2]
  double tilt_max = 0.611;           ///< of the thrust axis from the vertical [rad]
  double stop_tilt_max = 0.785;      ///< that stops in wind may count on [rad]
  double camera_half_angle = 0.785;  ///< of the downward camera's cone [rad]
};

/// The remaining limits while a steady `pull_W`, a force over the mass [m/s^2], acts beside gravity. The acceleration
/// is what thrust and tilt still allow in any horizontal direction in level flight. Where that is little, plans take
/// up to kShareOfReserve of the limit from the tracking law's reserve of tilt. They take no more than it has, and
/// never get less than kLeastAcceleration. Stops use what the tracking law's own tilt leaves, at most the whole
/// limit. Without a pull the limits themselves.
Limits LimitsUnder(const Limits& limits, const VehicleFacts& vehicle,
                   const Eigen::Vector3d& pull_W) noexcept;

/// With less than this share of its acceleration a vehicle could hardly follow a pad.
inline constexpr double kShareOfReserve = 1.0 / 3.0;
/// With less, there is no scale on which to make a plan [m/s^2].
inline constexpr double kLeastAcceleration = 0.3;

}  // namespace touchdown::planning
