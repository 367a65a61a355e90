// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

// A vehicle is an MJCF file with
// - one body `vehicle` with a free joint, an <inertial> at its origin with principal axes along
// B's;
// - a cylinder geom `hull` about z_B that holds body, arms and rotor discs, and feet: sphere geoms
//   whose names begin with `foot`; other geoms with contype = conaffinity = 0 are for the eye only;
// - sites and actuators `rotor0` to `rotor3`: gear "0 0 1 0 0 k", k the reaction torque per newton
//   with the rotor's sign, a control range, and dyntype="filter" with the thrust lag in dynprm; a
//   site that is a cylinder gives the radius of the rotor's disc;
// - <custom> numerics `rotor_drag` (three) and `body_drag_area` (one).

/// MJCF text of the vehicle that comes with the library (sim/models/quadrotor.xml).
std::string DefaultVehicleMjcf();

/// Text of the file at `path`. Throws std::invalid_argument naming the path if it cannot be read.
std::string ReadVehicleFile(const std::string& path);

/// The vehicle's parameters as read from the model MuJoCo compiles from `mjcf`. Throws
/// std::invalid_argument with MuJoCo's own message (it names the line) if it is no valid MJCF, or
/// naming what the file lacks of the list above.
estimation::VehicleModel LoadVehicleModel(const std::string& mjcf);

/// Throws std::invalid_argument saying what is wrong with a vehicle's file.
[[noreturn]] void RefuseVehicle(const std::string& what);

}  // namespace touchdown::sim
