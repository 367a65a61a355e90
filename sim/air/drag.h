// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

/// Density of air at sea level in the standard atmosphere [kg/m^3].
inline constexpr double kAirDensity = 1.225;

/// Aerodynamic force on the vehicle in W [N]. Rotor drag is linear along B's axes; body drag is
/// quadratic:
/// F = -R diag(d) R^T u - 1/2 rho CdA |u| u  with u = v - wind the velocity through air.
/// Does not allocate.
/// @param R_WB attitude, B to W.
/// @param u_W velocity of the vehicle minus that of the air, in W [m/s].
Eigen::Vector3d DragForce(const estimation::VehicleModel& model, const Eigen::Matrix3d& R_WB,
                          const Eigen::Vector3d& u_W);

}  // namespace touchdown::sim
