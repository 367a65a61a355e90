// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/control/tracking/controller.h"

namespace touchdown::control {

/// A desired force within the limits.
struct LimitedForce {
  Eigen::Vector3d f_W = Eigen::Vector3d::Zero();  ///< [N]
  bool tilt_limited = false;
  bool thrust_limited = false;
};

/// Brings the desired thrust vector within the options' limits. The vertical part is raised to its
/// least. The tilt is cut by shortening the horizontal part (its direction is kept). The length is
/// cut last (the whole direction is kept). `thrust_max` is the model's greatest thrust [N].
/// `thrust_gain` is the ratio of the rotors' thrust to the model's, `tilt_most` a limit besides the
/// options' [rad]. Does not allocate.
LimitedForce LimitForce(const Eigen::Vector3d& f_W, const estimation::VehicleModel& model,
                        const ControllerOptions& options, double thrust_max, double thrust_gain,
                        double tilt_most);

/// Force of the position loop [N], shared by both laws: m (a_ref + g - kp e_p - kv e_v), eq. 19.
Eigen::Vector3d PositionLoop(const estimation::VehicleState& state,
                             const planning::FlatState& reference,
                             const estimation::VehicleModel& model,
                             const ControllerOptions& options);

/// Moves the reference towards the vehicle. The horizontal part of PositionLoop is then as with
/// `frequency_share` times its frequency: the stiffness goes with its square, the damping with the
/// first power. In [0, 1], 1 changes nothing.
void SoftenHorizontally(double frequency_share, const estimation::VehicleState& state,
                        planning::FlatState* reference);

/// 1/2 vee(Rd' R - R' Rd): the attitude error on SO(3), a rotation vector for small angles.
Eigen::Vector3d AttitudeError(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& R_WB_desired);

}  // namespace touchdown::control
