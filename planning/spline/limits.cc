// SPDX-License-Identifier: BSD-3-Clause
// The thrust over the mass that flies an acceleration a against a pull d is f = a + g e_z - d
// (differential flatness, D. Mellinger and V. Kumar, ICRA 2011). In level flight its vertical part
// is g - d_z. Its horizontal part is at worst |a| + |d_xy|. It must stay below tan(tilt) times the
// vertical part, and both together below the greatest thrust. Conservative: the pull may come from
// the worst direction.

#include "touchdown/planning/spline/limits.h"

#include <algorithm>
#include <cmath>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {

Limits LimitsUnder(const Limits& limits, const VehicleFacts& vehicle,
                   const Eigen::Vector3d& pull_W) noexcept {
  if (pull_W.isZero(0.0)) return limits;
  const double up = std::max(0.0, estimation::kGravity - pull_W.z());
  const double of_thrust =
      std::sqrt(std::max(0.0, vehicle.thrust_max * vehicle.thrust_max - up * up));
  const auto left_by = [&](double tilt) {
    return std::min(std::tan(tilt) * up, of_thrust) - pull_W.head<2>().norm();
  };
  const double least = std::min(kLeastAcceleration, limits.acceleration);
  const double reserve =
      std::max(least, left_by(std::max(vehicle.tilt_max, vehicle.stop_tilt_max)));
  const double left =
      std::max(left_by(vehicle.tilt_max), std::min(kShareOfReserve * limits.acceleration, reserve));
  Limits under = limits;
  under.pull_W = pull_W;
  under.acceleration = std::clamp(left, least, limits.acceleration);
  const double stopping = std::clamp(reserve, under.acceleration, limits.acceleration);
  under.braking_factor = stopping / under.acceleration;
  return under;
}

}  // namespace touchdown::planning
