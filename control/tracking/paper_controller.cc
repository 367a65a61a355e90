// SPDX-License-Identifier: BSD-3-Clause
// The paper's control law. Eq. 19-20: desired force from the position and velocity errors, gravity
// and the reference's acceleration; its part along z_B is U1. Eq. 21: moments proportional to the
// attitude error, with the small-angle error on SO(3). Eq. 22, quaternion to Euler angles, is not
// needed: the yaw is part of the desired rotation. The damping on the body rate is not printed in
// eq. 21 but in its source [14] (D. Mellinger, N. Michael, V. Kumar, IJRR 2012); without it the
// attitude would be an undamped oscillator, unstable with any rotor lag.

#include "control/tracking/paper_controller.h"

#include <algorithm>

#include "control/tracking/tracking_law.h"

namespace touchdown::control {

PaperController::PaperController(const estimation::VehicleModel& model,
                                 const ControllerOptions& options)
    : model_(model), options_(options) {
  Validate(model_);
  Validate(options_);
  thrust_max_ = estimation::AllocationOf(model_).thrust_max;
}

ControlOutput PaperController::Update(const estimation::VehicleState& state,
                                      const planning::FlatState& reference,
                                      const Disturbance& /*disturbance*/,
                                      double tilt_most) const noexcept {
  const Eigen::Matrix3d R_WB = state.q_WB.toRotationMatrix();
  const LimitedForce force = LimitForce(PositionLoop(state, reference, model_, options_), model_,
                                        options_, thrust_max_, 1.0, tilt_most);

  ControlOutput output;
  output.R_WB_desired = planning::AttitudeFromThrust(force.f_W, reference.yaw);
  output.tilt_limited = force.tilt_limited;
  output.thrust_limited = force.thrust_limited;
  output.wrench.thrust = std::max(0.0, force.f_W.dot(R_WB.col(2)));

  const Eigen::Vector3d frequency(options_.attitude_frequency, options_.attitude_frequency,
                                  options_.yaw_frequency);
  const Eigen::Vector3d damping(options_.attitude_damping, options_.attitude_damping,
                                options_.yaw_damping);
  const Eigen::Vector3d e_R = AttitudeError(R_WB, output.R_WB_desired);
  output.wrench.moment_B =
      -model_.MomentFor(frequency.cwiseProduct(frequency).cwiseProduct(e_R) +
                        2.0 * damping.cwiseProduct(frequency).cwiseProduct(state.w_WB_B));
  return output;
}

}  // namespace touchdown::control
