// SPDX-License-Identifier: BSD-3-Clause
// Limit on the norm of the acceleration through its control points
// A_i = (Q_i - 2 Q_{i+1} + Q_{i+2})/h^2, i = 1..N-3. The acceleration is linear between them, so
// that the limit holds on the whole curve. Convex at fixed h.

#include "planning/problem/terms/norm_limit.h"

namespace touchdown::planning {

TermEntry AccelerationLimitTerm() {
  TermEntry entry;
  entry.info = {"acceleration_limit", "w sum hinge((|A|^2 - amax^2) / (2 amax))", "m/s^2",
                "paper eq. 15", true};
  entry.default_weight = 30.0;
  entry.parameters = {HingeWidth(1.0, "m/s^2"), SoftMargin()};
  entry.is_limit = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    return MakeNormLimit<2>(info, setup, setup.limits.acceleration);
  };
  return entry;
}

}  // namespace touchdown::planning
