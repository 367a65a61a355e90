// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/obstacles/obstacle.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::sim {

/// Thrust of a rotor near the ground over its thrust far from it, at the same speed of rotation;
/// >= 1. Does not allocate.
/// @param radius of the rotor [m], > 0.
/// @param height of its hub above the surface below [m]; less than half a radius counts as that.
/// @param thrust far from the ground [N]; <= 0: the ratio is 1.
/// @param airspeed horizontal speed through the air [m/s].
double GroundEffectRatio(double radius, double height, double thrust, double airspeed);

/// What the surface below adds to the rotors' thrusts.
struct GroundEffect {
  double thrust = 0.0;                                 ///< along z_B [N]
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  ///< [N m]
};

/// Each rotor over what lies below its hub: the deck, else the ground at z_W = 0. Does not allocate.
/// @param thrusts per rotor far from the ground [N].
/// @param deck the board in W.
/// @param airspeed horizontal speed through the air [m/s].
GroundEffect GroundEffectOf(const estimation::VehicleModel& model,
                            const estimation::VehicleState& vehicle,
                            const estimation::Commands& thrusts, const Box& deck, double airspeed);

}  // namespace touchdown::sim
