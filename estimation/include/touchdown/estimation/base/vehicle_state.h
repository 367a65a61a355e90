// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace touchdown::estimation {

/// Rigid-body state of the quadrotor. W: world (ENU), B: body (x forward, y left, z along thrust).
struct VehicleState {
  double t = 0.0;                                            ///< time stamp [s]
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();            ///< centre of mass in W [m]
  Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();            ///< its velocity in W [m/s]
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  ///< attitude, B to W
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();          ///< angular rate, in B [rad/s]
};

/// Heading of the body x axis in the world's horizontal plane [rad], in (-pi, pi].
double Yaw(const Eigen::Quaterniond& q_WB);

/// Angle between the body's thrust axis and the vertical [rad], in [0, pi].
double Tilt(const Eigen::Quaterniond& q_WB);

/// Angle wrapped to (-pi, pi] [rad].
double WrapAngle(double angle);

}  // namespace touchdown::estimation
