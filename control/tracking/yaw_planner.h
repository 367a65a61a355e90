// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::control {

/// Heading reference: a yaw and its exact time derivative.
struct YawState {
  double yaw = 0.0;   ///< [rad], wrapped to (-pi, pi]
  double rate = 0.0;  ///< [rad/s]
};

struct YawLimits {
  double rate = 2.0;          ///< > 0 [rad/s]
  double acceleration = 4.0;  ///< > 0 [rad/s^2]
};

/// The reference dt seconds later on its way to the heading `desired` [rad], by the shorter turn,
/// within the limits and without overshoot. The rate changes linearly within the step and the yaw
/// is its integral. A `desired` that is not finite brakes to rest. Throws std::invalid_argument for
/// dt < 0 or limits <= 0. Does not allocate.
YawState StepYaw(const YawState& state, double desired, double dt, const YawLimits& limits = {});

/// True when the heading is within `tolerance` [rad] of `desired` [rad].
bool YawAligned(double yaw, double desired, double tolerance);

}  // namespace touchdown::control
