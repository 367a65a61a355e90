// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/pad_prediction.h"
#include "touchdown/planning/endpoint.h"
#include "touchdown/planning/occupancy_map.h"
#include "touchdown/planning/uniform_bspline.h"

namespace touchdown::planning {

/// Limits on the norms of velocity and acceleration.
struct Limits {
  double speed = 3.0;         ///< [m/s]
  double acceleration = 6.0;  ///< [m/s^2]
};

/// What was proven about a plan before it may be flown. No plan is flown with passed() false.
struct Certificate {
  bool endpoint_required = true;            ///< false for braking and climbing: they end at rest
  double endpoint_position_residual = 0.0;  ///< |p(T) - wanted| [m]
  double endpoint_velocity_residual = 0.0;  ///< |v(T) - wanted| [m/s]
  double speed_bound = 0.0;                 ///< hull bound over the curve [m/s]
  double acceleration_bound = 0.0;          ///< hull bound over the curve [m/s^2]
  bool limits_kept = false;                 ///< bounds within the limits, or the recovery profile
  bool recovering = false;                  ///< the start was beyond a limit: certified against
                                            ///< the recovery profile instead
  bool clear = false;                       ///< every cell the curve passes is free after inflation
  double clearance = 0.0;                   ///< the inflation radius that `clear` stands for [m]
  double first_hit_t = 0.0;                 ///< absolute time of the first blocked cell if !clear [s]

  bool endpoint_met() const {
    return !endpoint_required ||
           (endpoint_position_residual <= 1e-9 && endpoint_velocity_residual <= 1e-9);
  }
  bool passed() const { return endpoint_met() && limits_kept && clear; }
};

/// Certifies `curve` from `t_from` to its end: the endpoint against `wanted` (nullptr: none is
/// required), the limits by the convex hull, the clearance by visiting every cell of `map` that the
/// curve passes. Does not allocate.
Certificate Certify(const UniformBspline& curve, double t_from, const SplineState* wanted,
                    const Limits& limits, const OccupancyMap& map);

}  // namespace touchdown::planning
