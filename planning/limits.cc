// SPDX-License-Identifier: BSD-3-Clause
// The thrust over the mass that flies an acceleration a against a pull d is f = a + g e_z - d
// (differential flatness, D. Mellinger and V. Kumar, ICRA 2011). In level flight its vertical part is
// g - d_z, and its horizontal part, at worst |a| + |d_xy|, is to stay below tan(tilt) times that, and
// with it below the greatest thrust. Conservative: the pull may come from the worst direction.

#include "touchdown/planning/limits.h"

#include <algorithm>
#include <cmath>

#include "touchdown/estimation/vehicle_model.h"

namespace touchdown::planning {

Limits LimitsUnder(const Limits& limits, const VehicleFacts& vehicle,
                   const Eigen::Vector3d& pull_W) noexcept {
  if (pull_W.isZero(0.0)) return limits;
  const double up = std::max(0.0, estimation::kGravity - pull_W.z());
  const double of_tilt = std::tan(vehicle.tilt_max) * up;
  const double of_thrust =
      std::sqrt(std::max(0.0, vehicle.thrust_max * vehicle.thrust_max - up * up));
  const double left = std::min(of_tilt, of_thrust) - pull_W.head<2>().norm();
  Limits under = limits;
  under.acceleration =
      std::clamp(left, kLeastShareInWind * limits.acceleration, limits.acceleration);
  under.braking_factor = limits.acceleration / under.acceleration;
  return under;
}

}  // namespace touchdown::planning
