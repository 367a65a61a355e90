// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace touchdown::estimation {

/// Matrix of the cross product: Skew(a) b = a x b.
Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

/// Unit quaternion of a rotation vector (axis times angle) [rad], of any length.
Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& phi);

/// Rotation vector of a unit quaternion [rad], its length in [0, pi].
Eigen::Vector3d LogRotation(const Eigen::Quaterniond& q);

/// The shortest turn that brings the direction of `from` into that of `to`; for opposite ones any half turn. Neither
/// is zero. (Eigen's Quaternion::FromTwoVectors uses a singular value decomposition for it, which takes seconds to
/// compile.)
Eigen::Quaterniond ShortestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Right Jacobian: ExpRotation(phi + d) = ExpRotation(phi) ExpRotation(RightJacobian(phi) d), d
/// small.
Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& phi);

}  // namespace touchdown::estimation
