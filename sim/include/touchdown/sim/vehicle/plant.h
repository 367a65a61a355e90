// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

/// How the simulated vehicle differs from the model that planner and controller know: factors, each
/// in [0.5, 2].
struct PlantFactors {
  double mass = 1.0;
  double inertia = 1.0;    ///< all three principal moments
  double drag = 1.0;       ///< rotor drag and body drag
  double rotor_lag = 1.0;  ///< time constant of the thrust
  double thrust = 1.0;     ///< of each actuator, over what it was told; reaction torques with it

  bool operator==(const PlantFactors&) const = default;
};

/// The vehicle that is simulated. Throws std::invalid_argument naming the factor, its value and the
/// allowed range; also if the altered vehicle cannot carry its weight.
estimation::VehicleModel AlteredVehicle(const estimation::VehicleModel& known,
                                        const PlantFactors& factors);

}  // namespace touchdown::sim
