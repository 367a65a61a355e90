// SPDX-License-Identifier: BSD-3-Clause
// How fast a vehicle's loops can be: the moments that its actuators have left at hover bound them.
#pragma once

#include "control/tracking/disturbance_observer.h"
#include "touchdown/control/tracking/controller.h"

namespace touchdown::control {

/// How fast a vehicle can follow, relative to the default frequencies; each in (0, 1].
struct BandwidthRatio {
  double tilt = 1.0;  ///< of roll and pitch, and of what is steered by them
  double yaw = 1.0;
};

/// Throws std::invalid_argument as estimation::AllocationOf does.
BandwidthRatio BandwidthRatioOf(const estimation::VehicleModel& model);

/// The default bandwidths, as slow as the vehicle is.
DisturbanceObserverOptions ObserverFor(const estimation::VehicleModel& model);

}  // namespace touchdown::control
