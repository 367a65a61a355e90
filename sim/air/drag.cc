// SPDX-License-Identifier: BSD-3-Clause
// Rotor drag (induced drag and blade flapping) linear in the air velocity along B's axes: M.
// Faessler, A. Franchi and D. Scaramuzza, "Differential flatness of quadrotor dynamics subject to
// rotor drag", IEEE Robotics and Automation Letters, 2018, eq. 2. Body drag: the ordinary quadratic
// law.

#include "sim/air/drag.h"

namespace touchdown::sim {

Eigen::Vector3d DragForce(const estimation::VehicleModel& model, const Eigen::Matrix3d& R_WB,
                          const Eigen::Vector3d& u_W) {
  const Eigen::Vector3d u_B = R_WB.transpose() * u_W;
  return -(R_WB * model.rotor_drag.cwiseProduct(u_B)) -
         0.5 * kAirDensity * model.body_drag_area * u_W.norm() * u_W;
}

}  // namespace touchdown::sim
