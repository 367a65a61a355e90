// SPDX-License-Identifier: BSD-3-Clause
// Geometric tracking on SE(3): T. Lee, M. Leok, N. H. McClamroch, CDC 2010, eq. 15-16. The desired
// body rate comes from the reference's jerk by differential flatness (planning/flatness). Its
// derivative would need the snap, which a cubic spline does not have, and is left out. Known linear
// rotor drag is fed forward on the reference's velocity (as M. Faessler, A. Franchi, D. Scaramuzza,
// RA-L 2018, section III model it). The estimated disturbance is subtracted from force and moment.
// Heading has the lowest priority for the rotors, and in the law: with a heading far off, the error
// on SO(3) would turn the thrust axis about the wrong axes.

#include "control/tracking/geometric_controller.h"

#include <algorithm>
#include <cmath>

#include "control/tracking/tracking_law.h"

namespace touchdown::control {

namespace {

/// Largest difference of the desired heading from the vehicle's [rad]. The tilt's error is turned
/// by half of it. Flights that keep up with their heading stay below.
constexpr double kFarthestHeading = 0.5;

/// The heading from which AttitudeFromThrust would make R_WB, while its thrust axis points up.
double HeadingOf(const Eigen::Matrix3d& R_WB) { return std::atan2(-R_WB(0, 1), R_WB(1, 1)); }

/// `yaw`, or as far towards it as kFarthestHeading leads. A vehicle upside down has no heading to keep.
double NearerHeading(double yaw, const Eigen::Matrix3d& R_WB) {
  const double heading = HeadingOf(R_WB), off = estimation::WrapAngle(yaw - heading);
  if (R_WB(2, 2) <= 0.0 || std::abs(off) <= kFarthestHeading) return yaw;
  return heading + std::copysign(kFarthestHeading, off);
}

}  // namespace

GeometricController::GeometricController(const estimation::VehicleModel& model,
                                         const ControllerOptions& options)
    : model_(model), options_(options) {
  Validate(model_);
  Validate(options_);
  thrust_max_ = estimation::AllocationOf(model_).thrust_max;
}

ControlOutput GeometricController::Update(const estimation::VehicleState& state,
                                          const planning::FlatState& reference,
                                          const Disturbance& disturbance,
                                          double tilt_most) const noexcept {
  const Eigen::Matrix3d R_WB = state.q_WB.toRotationMatrix();
  const Eigen::Vector3d drag_W =
      R_WB * model_.rotor_drag.asDiagonal() * R_WB.transpose() * reference.v_WB;
  const LimitedForce force =
      LimitForce(PositionLoop(state, reference, model_, options_) + drag_W - disturbance.force_W,
                 model_, options_, thrust_max_, disturbance.thrust_gain, tilt_most);

  // Flatness at the force that is really demanded, so that attitude and rate are consistent.
  planning::FlatState flat = reference;
  flat.yaw = NearerHeading(reference.yaw, R_WB);
  flat.a_WB = force.f_W / model_.mass_kg - estimation::kGravity * Eigen::Vector3d::UnitZ();
  // A force held at its limit does not follow the jerk any more.
  if (force.tilt_limited || force.thrust_limited) flat.j_WB.setZero();
  const planning::FlatInputs inputs = planning::InvertFlatness(flat);

  ControlOutput output;
  output.R_WB_desired = inputs.R_WB;
  output.w_WB_B_desired = inputs.w_WB_B;
  output.tilt_limited = force.tilt_limited;
  output.thrust_limited = force.thrust_limited;
  output.wrench.thrust = std::max(0.0, force.f_W.dot(R_WB.col(2))) / disturbance.thrust_gain;

  const Eigen::Vector3d frequency(options_.attitude_frequency, options_.attitude_frequency,
                                  options_.yaw_frequency);
  const Eigen::Vector3d damping(options_.attitude_damping, options_.attitude_damping,
                                options_.yaw_damping);
  const Eigen::Vector3d w_desired_B = R_WB.transpose() * inputs.R_WB * inputs.w_WB_B;
  const Eigen::Vector3d e_R = AttitudeError(R_WB, inputs.R_WB);
  const Eigen::Vector3d e_w = state.w_WB_B - w_desired_B;
  const Eigen::Vector3d angular_acceleration =
      -frequency.cwiseProduct(frequency).cwiseProduct(e_R) -
      2.0 * damping.cwiseProduct(frequency).cwiseProduct(e_w) - state.w_WB_B.cross(w_desired_B);
  output.wrench.moment_B = model_.MomentFor(angular_acceleration) +
                           model_.GyroscopicMoment(state.w_WB_B) - disturbance.moment_B;
  return output;
}

}  // namespace touchdown::control
