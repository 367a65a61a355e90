// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/vehicle/vehicle_findings.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

// A vehicle is an MJCF file with
// - one body `vehicle` with a free joint, and an <inertial> at its origin;
// - a cylinder geom `hull` about z_B that holds body, arms and rotor discs;
// - feet: sphere geoms whose names begin with `foot`;
// - other geoms, for the eye only, with contype = conaffinity = 0;
// - four to eight sites and actuators `rotor0`, `rotor1` ...:
//   - gear "0 0 1 0 0 k", k the reaction torque per newton with the rotor's sign;
//   - a control range, and dyntype="filter" with the thrust lag in dynprm, the same for all;
//   - a site that is a cylinder gives the radius of the rotor's disc;
//   - gear "0 0 0 x y z" makes a moment alone;
// - <custom> numerics `rotor_drag` (three) and `body_drag_area` (one).

/// MJCF text of the vehicle that comes with the library (sim/models/quadrotor.xml).
std::string DefaultVehicleMjcf();

/// Text of the file at `path`. Throws std::invalid_argument naming the path if it cannot be read.
std::string ReadVehicleFile(const std::string& path);

/// Whether it can be turned fast enough to be flown: 10 rad/s^2 about x and y, 0.5 about z. Throws as AllocationOf.
bool TurnsEnough(const estimation::VehicleModel& model);

/// The vehicle's parameters as read from the model MuJoCo compiles from `mjcf`.
/// @throws std::invalid_argument with MuJoCo's own message if it is no valid MJCF. Else the message
/// names all items of the list above that the file lacks. MuJoCo's message names the line.
estimation::VehicleModel LoadVehicleModel(const std::string& mjcf);

/// The same, but what the file lacks is added to `findings`; nothing then.
std::optional<estimation::VehicleModel> ReadVehicleModel(const std::string& mjcf,
                                                         VehicleFindings* findings);

}  // namespace touchdown::sim
