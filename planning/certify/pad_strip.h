// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/certify/free_space.h"
#include "touchdown/planning/spline/endpoint.h"

namespace touchdown::planning {

/// Lays the strip of `space` over the pad's way from t_start to t_end [s], as wide as `radius` to either side [m].
/// Over the pad a plan keeps off the deck: there the feet would stand with the body's origin `contact_height` above
/// it [m]. Or it goes no lower than its end, or its start if that is over the pad. The floor is the deck's, not the
/// plan's end: a vehicle that sinks, and must stay above, needs the room to stop. A pad without a deck lays none.
/// Does not allocate.
void LayPadStrip(const estimation::PadPrediction& pad, const EndpointTarget& target,
                 const Eigen::Vector3d& p_start, double t_start, double t_end, double radius,
                 double contact_height, FreeSpace* space) noexcept;

}  // namespace touchdown::planning
