// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::control {

/// A scalar reference and its rate after one step.
struct RateStep {
  double advance = 0.0;  ///< change of the reference in the step
  double rate = 0.0;     ///< its rate at the end
};

/// One step of dt seconds towards a point `distance` ahead (signed), at no more than `rate_max`.
/// The rate changes by no more than `acceleration` dt. The reference arrives at rest with an
/// overshoot of at most acceleration dt^2 / 8 (once the present rate allows it). The rate is linear
/// within the step, the advance its integral.
/// @pre dt >= 0, rate_max > 0, acceleration > 0. Does not allocate.
RateStep StepTowards(double distance, double rate, double rate_max, double acceleration, double dt);

}  // namespace touchdown::control
