// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/spline/endpoint.h"
#include "touchdown/planning/spline/limits.h"

namespace touchdown::planning {

/// A duration in which the moving endpoint can be reached within the limits. Its profile has a
/// speed plateau in the frame that moves with the end: speed up, cruise, slow down to match. A
/// quintic's duration would be 1.7 to 2 times the time optimum. `detour` >= 1 stretches the way.
/// +infinity if the end moves away faster than the vehicle may fly. Does not allocate.
double GuessDuration(const SplineState& start, double t0, const estimation::PadPrediction& pad,
                     const EndpointTarget& target, const Limits& limits, double detour) noexcept;

}  // namespace touchdown::planning
