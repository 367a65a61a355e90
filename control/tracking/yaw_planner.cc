// SPDX-License-Identifier: BSD-3-Clause
// Heading reference: the rate- and acceleration-limited profile of rate_profile.h on the wrapped
// difference to the desired heading. A reference that turns too fast to stop for a heading just
// passed comes back to it.

#include "control/tracking/yaw_planner.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "control/tracking/rate_profile.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::control {

YawState StepYaw(const YawState& state, double desired, double dt, const YawLimits& limits) {
  if (!(dt >= 0.0) || !(limits.rate > 0.0) || !(limits.acceleration > 0.0)) {
    throw std::invalid_argument(
        "StepYaw: dt, limits.rate, limits.acceleration = " + std::to_string(dt) + ", " +
        std::to_string(limits.rate) + ", " + std::to_string(limits.acceleration) +
        ", allowed: dt >= 0, both limits > 0");
  }
  // Braking to rest: the point where the present rate stops.
  const double braking = 0.5 * state.rate * std::abs(state.rate) / limits.acceleration;
  const double distance =
      std::isfinite(desired) ? estimation::WrapAngle(desired - state.yaw) : braking;
  const RateStep step = StepTowards(distance, state.rate, limits.rate, limits.acceleration, dt);
  return {estimation::WrapAngle(state.yaw + step.advance), step.rate};
}

bool YawAligned(double yaw, double desired, double tolerance) {
  return std::abs(estimation::WrapAngle(desired - yaw)) <= tolerance;
}

}  // namespace touchdown::control
