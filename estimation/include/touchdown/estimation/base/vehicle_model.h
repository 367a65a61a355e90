// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace touchdown::estimation {

/// Standard gravity [m/s^2]; the simulator's world uses the same figure.
inline constexpr double kGravity = 9.81;

/// One rotor, fixed in the body with its thrust along +z_B.
struct Rotor {
  Eigen::Vector3d p_BR = Eigen::Vector3d::Zero();  ///< hub in B [m]
  double spin = 1.0;  ///< +1 or -1: sign of the reaction torque about z_B per newton of thrust
};

/// What planner, controller and simulator know of a quadrotor. Filled from the vehicle's MJCF file
/// (sim/vehicle_file) or by hand in tests.
struct VehicleModel {
  double mass_kg = 1.18;
  Eigen::Vector3d inertia = {0.010, 0.010, 0.018};  ///< principal moments about B's axes [kg m^2]
  std::array<Rotor, 4> rotors;
  double rotor_thrust_min = 0.0;     ///< per rotor [N]
  double rotor_thrust_max = 7.0;     ///< per rotor [N]
  double rotor_lag_s = 0.035;        ///< first-order thrust lag [s]
  double torque_per_thrust = 0.016;  ///< reaction torque per newton [m] (tau/k of eq. 1-2)
  double rotor_radius = 0.0;         ///< of the disc [m]; 0: not known

  Eigen::Vector3d rotor_drag = Eigen::Vector3d::Zero();  ///< linear, along B's axes [N s/m]
  double body_drag_area = 0.0;                           ///< Cd A of the quadratic body drag [m^2]

  double hull_radius = 0.30;  ///< cylinder about z_B that holds body, arms and rotor discs [m]
  double hull_top = 0.08;     ///< its upper face above B's origin [m]
  double hull_bottom = 0.0;   ///< its lower face below B's origin [m]
  double foot_depth = 0.12;   ///< lowest point of the feet below B's origin [m], > 0
  double foot_radius = 0.16;  ///< horizontal distance of a foot from B's z axis [m]
  double foot_reach = 0.21;   ///< greatest distance of a point of the feet from B's origin [m]
  std::vector<double> foot_azimuths;  ///< of the feet about z_B, from x_B to y_B [rad]

  double MaxThrust() const { return 4.0 * rotor_thrust_max; }  ///< [N]
  double HoverThrust() const { return mass_kg * kGravity; }    ///< [N]
};

}  // namespace touchdown::estimation
