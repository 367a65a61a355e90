// SPDX-License-Identifier: BSD-3-Clause
// Rotation vectors and quaternions, in closed form with series near zero. J. Sola, Quaternion
// kinematics for the error-state Kalman filter, arXiv:1711.02508, eq. 101, 105 and 183.

#include "estimation/base/rotation_vector.h"

#include <cmath>

namespace touchdown::estimation {

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  // sin(angle/2)/angle; the next term of the series is below 1e-19.
  double scale = 0.5 - angle2 / 48.0;
  double cosine = 1.0 - angle2 / 8.0;
  if (angle2 > 1e-8) {
    const double angle = std::sqrt(angle2);
    scale = std::sin(0.5 * angle) / angle;
    cosine = std::cos(0.5 * angle);
  }
  Eigen::Quaterniond q(cosine, scale * phi.x(), scale * phi.y(), scale * phi.z());
  return q.normalized();
}

Eigen::Vector3d LogRotation(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  const double cosine = sign * q.w();
  const double scale = sine > 1e-9 ? 2.0 * std::atan2(sine, cosine) / sine : 2.0;
  return sign * scale * q.vec();
}

Eigen::Quaterniond ShortestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kOpposite = 1e-12;  // of one plus the cosine
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  if (1.0 + cosine < kOpposite) {
    const Eigen::Vector3d axis = a.unitOrthogonal();
    return {0.0, axis.x(), axis.y(), axis.z()};
  }
  const double s = std::sqrt((1.0 + cosine) * 2.0);
  const Eigen::Vector3d axis = a.cross(b) * (1.0 / s);
  return {0.5 * s, axis.x(), axis.y(), axis.z()};
}

Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  double first = 0.5 - angle2 / 24.0;
  double second = 1.0 / 6.0 - angle2 / 120.0;
  if (angle2 > 1e-6) {
    const double angle = std::sqrt(angle2);
    first = (1.0 - std::cos(angle)) / angle2;
    second = (angle - std::sin(angle)) / (angle2 * angle);
  }
  const Eigen::Matrix3d skew = Skew(phi);
  return Eigen::Matrix3d::Identity() - first * skew + second * skew * skew;
}

}  // namespace touchdown::estimation
