// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace touchdown::planning {

/// One instant of a reference trajectory: the flat outputs of a quadrotor with their derivatives.
struct FlatState {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d a_WB = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d j_WB = Eigen::Vector3d::Zero();  ///< [m/s^3]
  double yaw = 0.0;                                ///< heading of the body x axis [rad]
  double yaw_rate = 0.0;                           ///< [rad/s]
};

/// Attitude, body rate and specific thrust that fly a FlatState exactly (no drag).
struct FlatInputs {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();  ///< [rad/s]
  double specific_thrust = 0.0;                      ///< thrust over mass [m/s^2]
};

/// Attitude whose z axis is along `thrust_direction` (any length > 0) and whose x axis has the
/// heading `yaw`. Where the thrust is horizontal along that heading the x axis is undefined; the
/// nearest defined one is taken.
Eigen::Matrix3d AttitudeFromThrust(const Eigen::Vector3d& thrust_direction, double yaw);

/// Differential flatness of the quadrotor (Mellinger and Kumar 2011, the paper's [15]).
/// `j_WB` and `yaw_rate` give the body rate. Does not allocate.
FlatInputs InvertFlatness(const FlatState& flat);

}  // namespace touchdown::planning
