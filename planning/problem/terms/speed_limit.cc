// SPDX-License-Identifier: BSD-3-Clause
// Limit on the norm of the velocity through its control points V_i = (Q_{i+1} - Q_i)/h, i = 2..N-3.
// With the start's velocity, their hull contains every Bezier point of the curve's velocity. Convex
// at fixed h (a convex map under a nondecreasing convex loss).

#include "planning/problem/terms/norm_limit.h"

namespace touchdown::planning {

TermEntry SpeedLimitTerm() {
  TermEntry entry;
  entry.info = {"speed_limit", "w sum hinge((|V|^2 - vmax^2) / (2 vmax))", "m/s", "paper eq. 15",
                true};
  entry.default_weight = 300.0;
  entry.parameters = {HingeWidth(0.3, "m/s"), SoftMargin()};
  entry.is_limit = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    return MakeNormLimit<1>(info, setup, setup.limits.speed);
  };
  return entry;
}

}  // namespace touchdown::planning
