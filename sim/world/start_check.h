// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/world/world.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

/// Checks that the pad's motion and shape are in range and the vehicle's start state is finite. The
/// vehicle must not start in contact with an obstacle, the pad or the ground. World's constructor
/// calls it; a caller with a scenario file can call it before.
/// @throws std::invalid_argument naming the thing, its value and the allowed range.
void CheckStart(const WorldConfig& config, const estimation::VehicleModel& model);

}  // namespace touchdown::sim
