// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that is not what its pilot thinks it is.

#include "touchdown/sim/vehicle/plant.h"

#include <stdexcept>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

constexpr double kLeast = 0.5;
constexpr double kMost = 2.0;

}  // namespace

estimation::VehicleModel AlteredVehicle(const estimation::VehicleModel& known,
                                        const PlantFactors& factors) {
  estimation::CheckWithin("plant.mass", factors.mass, kLeast, kMost);
  estimation::CheckWithin("plant.inertia", factors.inertia, kLeast, kMost);
  estimation::CheckWithin("plant.drag", factors.drag, kLeast, kMost);
  estimation::CheckWithin("plant.rotor_lag", factors.rotor_lag, kLeast, kMost);
  estimation::CheckWithin("plant.thrust", factors.thrust, kLeast, kMost);
  estimation::VehicleModel plant = known;
  plant.mass_kg *= factors.mass;
  plant.inertia *= factors.inertia;
  plant.rotor_drag *= factors.drag;
  plant.body_drag_area *= factors.drag;
  plant.rotor_lag_s *= factors.rotor_lag;
  for (estimation::Actuator& actuator : plant.actuators) {
    actuator.min *= factors.thrust;
    actuator.max *= factors.thrust;
  }
  const double thrust_max = estimation::AllocationOf(plant).thrust_max;
  if (thrust_max <= plant.HoverThrust()) {
    throw std::invalid_argument("plant.mass is " + estimation::NumberText(factors.mass) +
                                " and plant.thrust is " + estimation::NumberText(factors.thrust) +
                                "; allowed is what leaves more thrust, " +
                                estimation::NumberText(thrust_max) + " N, than weight, " +
                                estimation::NumberText(plant.HoverThrust()) + " N");
  }
  return plant;
}

}  // namespace touchdown::sim
