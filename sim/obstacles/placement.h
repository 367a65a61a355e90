// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace touchdown::sim {

/// Where something from a file stands: F is the file's frame.
struct Placement {
  Eigen::Matrix3d R_WF = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WF = Eigen::Vector3d::Zero();  ///< [m]

  Eigen::Vector3d operator()(const Eigen::Vector3d& p_F) const { return R_WF * p_F + p_WF; }
};

/// The turn by roll about x, then pitch about y, then yaw about z [rad].
Eigen::Matrix3d TurnOf(double roll, double pitch, double yaw);

}  // namespace touchdown::sim
