// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/world/world.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

/// Throws std::invalid_argument, naming the thing, its value and the allowed range, if the pad's
/// motion or shape is out of range, the vehicle's start state is not finite, or the vehicle starts
/// in contact with an obstacle, the pad or the ground. World's constructor asks it; a caller with a
/// scenario file can ask before.
void CheckStart(const WorldConfig& config, const estimation::VehicleModel& model);

}  // namespace touchdown::sim
