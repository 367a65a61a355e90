// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "sim/sensors/own_sensor_rig.h"
#include "touchdown/control/onboard/onboard.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The sensors of the scenario's keys under own.
sim::OwnSensorRigConfig OwnSensorsOf(const Scenario& scenario);

/// The source of the vehicle's own state, as the scenario's own_state says: the truth, or sensors.
class OwnSense {
 public:
  /// `seed` feeds the sensors' own streams. @throws std::invalid_argument naming key, value and range.
  OwnSense(const Scenario& scenario, std::uint64_t seed);

  /// The time before the flight, in which it hovers at `start`. @param timestep of the physics [s].
  void Hover(const estimation::VehicleState& start, double timestep, control::Onboard* onboard);

  /// Call once per physics step, first at t = 0. Does not allocate.
  void Sense(const estimation::VehicleState& truth, control::Onboard* onboard);

 private:
  std::optional<sim::OwnSensorRig> rig_;  ///< none: the truth
};

}  // namespace touchdown::evaluation
