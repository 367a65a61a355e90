// SPDX-License-Identifier: BSD-3-Clause
// Differential flatness of the quadrotor: thrust direction from the acceleration, heading from the
// yaw, body rate from the jerk and the yaw rate. D. Mellinger and V. Kumar, "Minimum snap
// trajectory generation and control for quadrotors", ICRA 2011, section III.

#include "touchdown/planning/spline/flatness.h"

#include <cmath>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {

Eigen::Matrix3d AttitudeFromThrust(const Eigen::Vector3d& thrust_direction, double yaw) {
  const Eigen::Vector3d z_B = thrust_direction.normalized();
  const Eigen::Vector3d heading(std::cos(yaw), std::sin(yaw), 0.0);
  Eigen::Vector3d y_B = z_B.cross(heading);
  // Thrust along the heading: the body's y axis keeps the heading's left side.
  if (y_B.squaredNorm() < 1e-12) y_B = Eigen::Vector3d(-heading.y(), heading.x(), 0.0);
  y_B.normalize();
  Eigen::Matrix3d R_WB;
  R_WB << y_B.cross(z_B), y_B, z_B;
  return R_WB;
}

FlatInputs InvertFlatness(const FlatState& flat) {
  FlatInputs inputs;
  const Eigen::Vector3d thrust = flat.a_WB + estimation::kGravity * Eigen::Vector3d::UnitZ();
  inputs.specific_thrust = thrust.norm();
  inputs.R_WB = AttitudeFromThrust(thrust, flat.yaw);
  if (inputs.specific_thrust < 1e-6) return inputs;  // free fall: no direction, no rate

  const Eigen::Vector3d x_B = inputs.R_WB.col(0);
  const Eigen::Vector3d y_B = inputs.R_WB.col(1);
  const Eigen::Vector3d z_B = inputs.R_WB.col(2);
  // z_B turns with the part of the jerk normal to it: z_B' = w x z_B.
  const Eigen::Vector3d dz_B = (flat.j_WB - z_B.dot(flat.j_WB) * z_B) / inputs.specific_thrust;
  const double p = -y_B.dot(dz_B);
  const double q = x_B.dot(dz_B);
  // The heading vector stays normal to y_B: d/dt (y_B . heading) = 0 gives the yaw component r.
  const Eigen::Vector3d heading(std::cos(flat.yaw), std::sin(flat.yaw), 0.0);
  const Eigen::Vector3d dheading = flat.yaw_rate * Eigen::Vector3d(-heading.y(), heading.x(), 0.0);
  // y_B' = -r x_B + p z_B.
  const double along_x = x_B.dot(heading);
  const double r =
      std::abs(along_x) < 1e-9 ? 0.0 : (p * z_B.dot(heading) + y_B.dot(dheading)) / along_x;
  inputs.w_WB_B = Eigen::Vector3d(p, q, r);
  return inputs;
}

}  // namespace touchdown::planning
