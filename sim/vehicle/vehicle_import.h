// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/vehicle/vehicle_findings.h"

namespace touchdown::sim {

/// What MJCF multirotors in the common form do not say, or say wrong.
struct AirframeExtras {
  double rotor_lag = 0.03;      ///< of motors without dynamics [s], in [0.005, 1]
  double rotor_drag = 0.0;      ///< linear, along x_B and y_B [N s/m]
  double body_drag_area = 0.0;  ///< [m^2]
  /// Cylinder about z_B through the centre of mass that collides: radius, bottom and top [m]. Zero: one
  /// that holds every geom and motor.
  Eigen::Vector3d hull = Eigen::Vector3d::Zero();
  /// Distance of the feet from z_B and depth of their soles below B [m]. Zero: 0.6 of the hull's radius,
  /// and 0.35 of that below the hull.
  Eigen::Vector2d feet = Eigen::Vector2d::Zero();
  /// +1 or -1 for each rotor in the file's order: the sign of its reaction torque about z_B. Empty: the file's.
  std::vector<double> rotor_senses;
  /// If the file's signs cannot make a yaw moment, neighbours turn against each other, with a warning.
  bool alternate_senses = false;
  /// Of actuators that make a moment alone, about x, y and z [N m]. Zero: the file's.
  Eigen::Vector3d moment_max = Eigen::Vector3d::Zero();
};

/// MJCF text, in the form of sim/vehicle/vehicle_file.h, of the multirotor in the file at `path`. A file in that form
/// is returned as it is. Another file must have exactly one joint, a free one, and four to eight actuators. Each
/// actuator pushes along the body's z axis at a site, or makes a moment alone. Names and the place of the mass do not
/// matter, and bodies may be joined rigidly. Mass, inertia, arms, limits (of control and force) and reaction torques
/// are read from the compiled model. Its geoms, including meshes, count as the outline only. What collides is the hull
/// and four feet.
/// B is at the centre of mass, with the axes of the body that has the free joint.
/// Throws std::invalid_argument with MuJoCo's message, or saying all that the file lacks of this.
std::string ImportVehicle(const std::string& path, const AirframeExtras& extras);

/// The same, but what the file lacks is added to `findings`, and the text is empty then. Warnings too.
std::string ImportVehicle(const std::string& path, const AirframeExtras& extras,
                          VehicleFindings* findings);

/// Whether ImportVehicle returns the file as it is, with nothing left to say. Throws likewise.
bool IsInOwnForm(const std::string& path);

}  // namespace touchdown::sim
