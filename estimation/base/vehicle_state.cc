// SPDX-License-Identifier: BSD-3-Clause
// Angles from an attitude quaternion. Yaw is the heading of the body x axis projected to the
// horizontal plane. It is the yaw of the paper's eq. 22 with its numerator read as wz + xy.

#include "touchdown/estimation/base/vehicle_state.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchdown::estimation {

double Yaw(const Eigen::Quaterniond& q_WB) {
  const Eigen::Vector3d x_B = q_WB * Eigen::Vector3d::UnitX();
  return std::atan2(x_B.y(), x_B.x());
}

double Tilt(const Eigen::Quaterniond& q_WB) {
  const Eigen::Vector3d z_B = q_WB * Eigen::Vector3d::UnitZ();
  return std::acos(std::clamp(z_B.z(), -1.0, 1.0));
}

double WrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace touchdown::estimation
