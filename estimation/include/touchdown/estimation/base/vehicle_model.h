// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace touchdown::estimation {

/// Standard gravity [m/s^2]; the simulator's world uses the same figure.
inline constexpr double kGravity = 9.81;

/// A vehicle has four actuators at least and so many at most.
inline constexpr int kLeastActuators = 4, kMostActuators = 8;

/// A command or an answer of each actuator, in the order of VehicleModel::actuators. In newtons of thrust, or in
/// newton metres for actuators without thrust. Never on the heap.
using Commands = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostActuators, 1>;

/// One actuator, fixed in the body: its effect per unit of its command. A rotor has a command in newtons, thrust
/// along +z_B at its hub, and a reaction torque. Models that do not distinguish their rotors have one actuator of
/// thrust and three that make a moment alone, with commands in newton metres.
struct Actuator {
  Eigen::Vector3d p_BR = Eigen::Vector3d::Zero();      ///< where it pushes, in B [m]
  double thrust = 1.0;                                 ///< along +z_B per unit: 1, or 0
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  ///< beside that of the thrust, per unit
  double min = 0.0;                                    ///< of the command, after its lag
  double max = 0.0;
};

/// A rotor with its hub at p_BR [m]. `torque_per_thrust` is the reaction torque about z_B per newton of thrust with
/// its sign [m] (tau/k of eq. 1-2).
inline Actuator RotorAt(const Eigen::Vector3d& p_BR, double torque_per_thrust, double thrust_max,
                        double thrust_min = 0.0) {
  return {p_BR, 1.0, {0.0, 0.0, torque_per_thrust}, thrust_min, thrust_max};
}

/// What planner, controller and simulator know of a multirotor. Filled from the vehicle's MJCF file
/// (sim/vehicle_file) or by hand.
struct VehicleModel {
  double mass_kg = 1.18;
  Eigen::Vector3d inertia = {0.010, 0.010, 0.018};     ///< principal moments [kg m^2] ...
  Eigen::Matrix3d R_BI = Eigen::Matrix3d::Identity();  ///< ... about the columns' axes
  std::vector<Actuator> actuators;
  double rotor_lag_s = 0.035;  ///< first-order lag of every actuator [s]
  double rotor_radius = 0.0;   ///< of the rotors' discs [m]; 0: not known

  Eigen::Vector3d rotor_drag = Eigen::Vector3d::Zero();  ///< linear, along B's axes [N s/m]
  double body_drag_area = 0.0;                           ///< Cd A of the quadratic body drag [m^2]

  double hull_radius = 0.30;  ///< cylinder about z_B that holds body, arms and rotor discs [m]
  double hull_top = 0.08;     ///< its upper face above B's origin [m]
  double hull_bottom = 0.0;   ///< its lower face below B's origin [m]
  double foot_depth = 0.12;   ///< lowest point of the feet below B's origin [m], > 0
  double foot_radius = 0.16;  ///< horizontal distance of a foot from B's z axis [m]
  double foot_reach = 0.21;   ///< greatest distance of a point of the feet from B's origin [m]
  std::vector<double> foot_azimuths;  ///< of the feet about z_B, from x_B to y_B [rad]

  double HoverThrust() const { return mass_kg * kGravity; }  ///< [N]

  /// Moment that turns at the angular acceleration [rad/s^2], without the gyroscopic one; both in B [N m].
  Eigen::Vector3d MomentFor(const Eigen::Vector3d& acceleration_B) const {
    return R_BI * inertia.cwiseProduct(R_BI.transpose() * acceleration_B);
  }
  /// Angular acceleration [rad/s^2] under a moment [N m], both in B, without the gyroscopic one.
  Eigen::Vector3d AccelerationUnder(const Eigen::Vector3d& moment_B) const {
    return R_BI * (R_BI.transpose() * moment_B).cwiseQuotient(inertia);
  }
  /// w x J w [N m].
  Eigen::Vector3d GyroscopicMoment(const Eigen::Vector3d& w_WB_B) const {
    return w_WB_B.cross(MomentFor(w_WB_B));
  }
};

/// Which commands make which wrench: (thrust along z_B, moment about x_B, y_B, z_B) [N, N m].
struct Allocation {
  Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::ColMajor, 4, kMostActuators> wrench_of_commands;
  /// Its inverse; with more than four actuators that of least squares of the commands as shares of their ranges.
  Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::ColMajor, kMostActuators, 4> commands_of_wrench;
  /// Of the thrust without any moment that the actuators' ranges allow [N].
  double thrust_min = 0.0, thrust_max = 0.0;

  /// Each actuator's part in a thrust without a moment, per newton; above 0 of those that make thrust.
  auto Shares() const { return commands_of_wrench.col(0); }
};

/// Throws std::invalid_argument unless there are kLeastActuators to kMostActuators of them with finite figures and
/// min < max. They must span thrust and three moments, and none may push down in a hover without a moment.
Allocation AllocationOf(const VehicleModel& model);

/// Greatest angular acceleration about each of B's axes from hover, in the slower sense, at the same thrust
/// [rad/s^2]. Throws as AllocationOf.
Eigen::Vector3d HoverTurn(const VehicleModel& model);

}  // namespace touchdown::estimation
