// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// The rest of `previous` from `t0` on as a spline with `segments` segments that takes `duration`.
/// It is the start of the next solve, after View::Restrict. Times are stretched evenly, so that the
/// path stays. With the previous number of segments, t0 and duration the control points stay the
/// same. t0 is clamped to the previous curve; past its end the result stands there. Throws
/// std::invalid_argument unless segments >= 1 and duration is positive and finite. Allocates.
UniformBspline ShiftedSpline(const UniformBspline& previous, double t0, double duration,
                             int segments);

/// Its control points alone, as many as `points` has columns (at least 4). Throws std::invalid_argument
/// unless duration is positive and finite. Does not allocate.
void ShiftedControlPoints(const UniformBspline& previous, double t0, double duration,
                          Eigen::Ref<ControlPoints> points);

/// The curve moved so that it starts and ends in the given states. The differences at the ends are
/// spread over it as a quintic, so that a small step at an end makes no jolt beside it. Allocates.
UniformBspline WithEnds(const UniformBspline& curve, const SplineState& start,
                        const SplineState& end);

}  // namespace touchdown::planning
