// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::sim {

/// Parts of MJCF text that show a vehicle.
struct VehicleLooks {
  std::string assets;  ///< its meshes, to stand in <asset>
  std::string geoms;   ///< in B, to stand in a <body>
};

/// The vehicle of an MJCF text (sim/vehicle/vehicle_file.h): its VehicleShapes, and a disc of rotor_radius at each rotor.
/// Throws std::invalid_argument as LoadVehicleModel.
VehicleLooks LooksOf(const std::string& vehicle_mjcf);

}  // namespace touchdown::sim
