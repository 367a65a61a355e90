// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/pad/pad_geometry.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

/// What the pad vehicle's wake adds to the velocity of the air at p_W, in W [m/s]: air behind it is
/// dragged along. Nothing upstream of its centre. Does not allocate.
/// @param wind_W velocity of the air far from the pad vehicle [m/s].
Eigen::Vector3d PadWake(const PadGeometry& geometry, const estimation::PadState& pad,
                        const Eigen::Vector3d& wind_W, const Eigen::Vector3d& p_W);

}  // namespace touchdown::sim
