// SPDX-License-Identifier: BSD-3-Clause
// Shared by both tracking laws: the position loop (the paper's eq. 19), the limits of the desired
// force, and the attitude error. The last is eq. 8 of T. Lee, M. Leok, N. H. McClamroch, "Geometric
// tracking control of a quadrotor UAV on SE(3)", CDC 2010.

#include "control/tracking/tracking_law.h"

#include <algorithm>
#include <cmath>

namespace touchdown::control {

LimitedForce LimitForce(const Eigen::Vector3d& f_W, const estimation::VehicleModel& model,
                        const ControllerOptions& options, double thrust_max, double thrust_gain,
                        double tilt_most) {
  LimitedForce limited;
  limited.f_W = f_W;
  // Thrust cannot pull down: a hard demand to fall becomes the least upward force, so that the
  // desired attitude never turns over.
  const double least = options.thrust_fraction_min * model.HoverThrust();
  if (limited.f_W.z() < least) {
    limited.f_W.z() = least;
    limited.thrust_limited = true;
  }
  const double horizontal = limited.f_W.head<2>().norm();
  const double horizontal_max = limited.f_W.z() * std::tan(std::min(options.tilt_max, tilt_most));
  if (horizontal > horizontal_max) {
    limited.f_W.head<2>() *= horizontal_max / horizontal;
    limited.tilt_limited = true;
  }
  const double length = limited.f_W.norm();
  const double length_max = options.thrust_fraction_max * thrust_gain * thrust_max;
  if (length > length_max) {
    limited.f_W *= length_max / length;
    limited.thrust_limited = true;
  }
  return limited;
}

Eigen::Vector3d PositionLoop(const estimation::VehicleState& state,
                             const planning::FlatState& reference,
                             const estimation::VehicleModel& model,
                             const ControllerOptions& options) {
  const Eigen::Vector3d frequency(options.position_frequency, options.position_frequency,
                                  options.height_frequency);
  const Eigen::Vector3d damping(options.position_damping, options.position_damping,
                                options.height_damping);
  const Eigen::Vector3d kp = frequency.cwiseProduct(frequency);
  const Eigen::Vector3d kv = 2.0 * damping.cwiseProduct(frequency);
  const Eigen::Vector3d e_p = state.p_WB - reference.p_WB;
  const Eigen::Vector3d e_v = state.v_WB - reference.v_WB;
  return model.mass_kg * (reference.a_WB + estimation::kGravity * Eigen::Vector3d::UnitZ() -
                          kp.cwiseProduct(e_p) - kv.cwiseProduct(e_v));
}

void SoftenHorizontally(double frequency_share, const estimation::VehicleState& state,
                        planning::FlatState* reference) {
  const auto draw = [](double share, const Eigen::Vector3d& to, Eigen::Vector3d* from) {
    from->head<2>() = to.head<2>() + share * (*from - to).head<2>();
  };
  draw(frequency_share * frequency_share, state.p_WB, &reference->p_WB);
  draw(frequency_share, state.v_WB, &reference->v_WB);
}

Eigen::Vector3d AttitudeError(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& R_WB_desired) {
  const Eigen::Matrix3d difference = R_WB_desired.transpose() * R_WB;
  return 0.5 * Eigen::Vector3d(difference(2, 1) - difference(1, 2),
                               difference(0, 2) - difference(2, 0),
                               difference(1, 0) - difference(0, 1));
}

}  // namespace touchdown::control
