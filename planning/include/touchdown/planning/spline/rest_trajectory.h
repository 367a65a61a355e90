// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/spline/limits.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// A trajectory from `start` at t0 to rest, `shift` away from where it would otherwise stop. With
/// no shift it is a braking trajectory with its real braking distance. Its duration is the shortest
/// of a geometric series whose derivative hulls keep the limits (or the start's own excess of
/// them).
UniformBspline MakeRestTrajectory(const SplineState& start, double t0, const Eigen::Vector3d& shift,
                                  const Limits& limits);

/// The same into a spline that is there already: does not allocate if it has held one before.
void MakeRestTrajectory(const SplineState& start, double t0, const Eigen::Vector3d& shift,
                        const Limits& limits, UniformBspline* trajectory);

}  // namespace touchdown::planning
