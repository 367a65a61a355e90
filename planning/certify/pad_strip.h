// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/certify/free_space.h"
#include "touchdown/planning/spline/endpoint.h"

namespace touchdown::planning {

/// Lays the strip of `space` over the pad's way from t_start to t_end [s], as wide as `radius` to either
/// side [m]: over the pad a plan keeps off the deck, on which the feet would stand with the body's origin
/// `contact_height` above it [m], or goes no lower than where it ends, or starts if that is over the pad.
/// The floor is the deck's and not the plan's end, because a vehicle that sinks when it is told to stay
/// above needs the way to stop in. A pad without a deck lays none. Does not allocate.
void LayPadStrip(const estimation::PadPrediction& pad, const EndpointTarget& target,
                 const Eigen::Vector3d& p_start, double t_start, double t_end, double radius,
                 double contact_height, FreeSpace* space) noexcept;

}  // namespace touchdown::planning
