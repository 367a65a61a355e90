// SPDX-License-Identifier: BSD-3-Clause
// Discrete bang-coast-bang profile. The next rate r' is the greatest that still stops in time. The
// rest of the step at the mean rate (r + r') dt / 2, plus the braking distance r'^2 / (2 a), must
// not exceed the distance. This is a quadratic in r'.

#include "control/tracking/rate_profile.h"

#include <algorithm>
#include <cmath>

namespace touchdown::control {

RateStep StepTowards(double distance, double rate, double rate_max, double acceleration,
                     double dt) {
  if (dt <= 0.0) return {0.0, rate};
  const double sign = distance < 0.0 ? -1.0 : 1.0;
  const double d = sign * distance;
  const double r = sign * rate;
  // r'^2 / (2 a) + r' dt / 2 + r dt / 2 - d = 0
  const double half = 0.5 * acceleration * dt;
  const double discriminant = half * half + 2.0 * acceleration * (d - 0.5 * r * dt);
  const double stopping = discriminant > 0.0 ? -half + std::sqrt(discriminant) : 0.0;
  const double wanted = std::clamp(stopping, 0.0, rate_max);
  const double next = std::clamp(wanted, r - acceleration * dt, r + acceleration * dt);
  return {sign * 0.5 * (r + next) * dt, sign * next};
}

}  // namespace touchdown::control
