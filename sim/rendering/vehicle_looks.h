// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::sim {

/// The vehicle of an MJCF text (sim/vehicle/vehicle_file.h) as geoms in B, to stand in a <body>: what is for the eye, feet and rotor
/// discs, but not the hull. Of a vehicle that has nothing for the eye, arms to rotors and feet.
/// Throws std::invalid_argument with MuJoCo's message, or if there is no body `vehicle`.
std::string VehicleLooks(const std::string& vehicle_mjcf);

}  // namespace touchdown::sim
