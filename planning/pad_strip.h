// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/pad_prediction.h"
#include "touchdown/planning/endpoint.h"
#include "touchdown/planning/free_space.h"

namespace touchdown::planning {

/// Lays the strip of `space` over the pad's way from t_start to t_end [s], as wide as `radius` to either
/// side [m]: over the pad a plan goes no lower than where it ends, or starts if that is over the pad,
/// because the pad vehicle is there. Does not allocate.
void LayPadStrip(const estimation::PadPrediction& pad, const EndpointTarget& target,
                 const Eigen::Vector3d& p_start, double t_start, double t_end, double radius,
                 FreeSpace* space) noexcept;

}  // namespace touchdown::planning
