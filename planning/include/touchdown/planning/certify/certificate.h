// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/certify/free_space.h"
#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/planning/spline/limits.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// A limit may be exceeded by this much [m/s, m/s^2, rad/s]. Some limits are met with equality: up to the rounding of
/// sums of control points, and as hard rows up to what backends count as feasible (Evaluator::kFeasible).
inline constexpr double kLimitSlack = 2e-6;

/// What was proven about a trajectory. A new plan is committed only if passed().
struct Certificate {
  bool endpoint_required = true;            ///< false for braking and climbing: they end at rest
  double endpoint_tolerance = 1e-9;         ///< on the residuals at both ends [m, m/s]
  double start_position_residual = 0.0;     ///< |p(t_from) - start| [m]
  double start_velocity_residual = 0.0;     ///< |v(t_from) - start| [m/s]
  double endpoint_position_residual = 0.0;  ///< |p(T) - wanted| [m]
  double endpoint_velocity_residual = 0.0;  ///< |v(T) - wanted| [m/s]
  /// The trajectory committed before is flown on. Its bounds and its clearance are not measured again, and are NaN
  /// here. stops_in_observed_space says whether it was proven then and still holds.
  bool earlier = false;
  /// DerivativeBounds over the curve [m/s], [m/s^2], [rad/s].
  double speed_bound = 0.0;
  double acceleration_bound = 0.0;
  double body_rate_bound = 0.0;
  bool limits_kept = false;  ///< bounds within the limits, or the recovery profile
  bool recovering = false;   ///< the start was beyond a limit: certified against
                             ///< the recovery profile instead
  bool clear = false;        ///< every cell the curve passes is free after inflation
  /// The start itself is blocked. The curve leaves the inflated cells, and on the way never comes
  /// back by more than 2 cm towards an occupied one.
  bool escaping = false;
  /// What is flown until a newer pair takes over, and the stop that is stored in case none does, stay in
  /// observed-free cells. They do so with the hull and its margins (touchdown/planning/certify/stored_stop.h).
  bool stops_in_observed_space = false;
  StartCells start_cells;    ///< that the pair starts among, and only moves away from
  double clearance = 0.0;    ///< that `clear` or `escaping` stands for [m]
  double first_hit_t = 0.0;  ///< absolute time of the first blocked cell if !clear [s]

  bool endpoint_met() const {
    return !endpoint_required || (endpoint_position_residual <= endpoint_tolerance &&
                                  endpoint_velocity_residual <= endpoint_tolerance);
  }
  bool start_met() const {
    return start_position_residual <= endpoint_tolerance &&
           start_velocity_residual <= endpoint_tolerance;
  }
  bool passed() const {
    return start_met() && endpoint_met() && limits_kept && (clear || escaping) &&
           stops_in_observed_space;
  }
};

/// Certifies `curve` from `t_from` to its end:
/// - its state there against `start` (nullptr: it starts there by construction),
/// - the endpoint against `wanted` (nullptr: none is required),
/// - the limits by the convex hull,
/// - the clearance by visiting every cell of `space` that the curve passes.
///
/// A start may be beyond the speed limit, by its speed or by V_1 = v0 + h a0 / 2, which it fixes. It is then
/// certified against the RecoveryProfile from the larger of the two on. The same holds for the acceleration. The
/// proof for the time until rest is separate (ProvePair, ProveStop), and the caller enters it:
/// stops_in_observed_space, start_cells (Enter in stored_stop.h). Does not allocate.
Certificate Certify(const UniformBspline& curve, double t_from, const SplineState* start,
                    const SplineState* wanted, const Limits& limits, const FreeSpace& space);

}  // namespace touchdown::planning
