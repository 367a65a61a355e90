// SPDX-License-Identifier: BSD-3-Clause
// Measurements of the vehicle's own sensors, as plain data. Produced by sim/, consumed by
// OwnStateFilter. All sensors sit in B's origin, the centre of mass: the driver corrects for lever
// arms.
#pragma once

#include <Eigen/Core>

namespace touchdown::estimation {

/// Mean specific force and mean angular rate over the interval from the sample before to t, as an
/// IMU that integrates inside delivers them.
struct ImuSample {
  double t = 0.0;                                    ///< end of the interval [s]
  Eigen::Vector3d f_B = Eigen::Vector3d::Zero();     ///< acceleration less gravity, in B [m/s^2]
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();  ///< in B [rad/s]
};

/// Position of the vehicle by GPS.
struct OwnPositionFix {
  double t = 0.0;                                  ///< time stamp [s]
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< in W [m]
  double sigma_horizontal = 0.02;                  ///< standard deviation of x and of y [m], >= 0
  double sigma_vertical = 0.04;                    ///< of z [m], >= 0
};

/// Velocity of the vehicle by odometry. In B, so that no drifting heading of its own enters.
struct OwnVelocityFix {
  double t = 0.0;                                    ///< time stamp [s]
  Eigen::Vector3d v_WB_B = Eigen::Vector3d::Zero();  ///< velocity in W, expressed in B [m/s]
  double sigma = 0.05;                               ///< standard deviation, each axis [m/s], >= 0
};

/// Height by barometer, above W's plane z = 0.
struct HeightSample {
  double t = 0.0;       ///< time stamp [s]
  double height = 0.0;  ///< z of B's origin in W [m]
  double sigma = 0.1;   ///< standard deviation [m], >= 0
};

/// Heading by magnetometer or by two antennas.
struct HeadingSample {
  double t = 0.0;        ///< time stamp [s]
  double yaw = 0.0;      ///< as Yaw() in vehicle_state.h [rad]
  double sigma = 0.035;  ///< standard deviation [rad], >= 0
};

}  // namespace touchdown::estimation
