// SPDX-License-Identifier: BSD-3-Clause
// The models of OwnStateFilter: motion from IMU samples, and the measurements of the other sensors.
// Each has its Jacobian with respect to the error state.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "touchdown/estimation/base/own_measurements.h"

namespace touchdown::estimation {

inline constexpr int kOwnErrors = 15;
using OwnVector = Eigen::Matrix<double, kOwnErrors, 1>;
using OwnMatrix = Eigen::Matrix<double, kOwnErrors, kOwnErrors>;

/// Where the parts of the error state begin, each of three numbers. The error is what has to be
/// added to the nominal state. The attitude error is a small rotation in B: q_true = q exp(error).
enum OwnError : int {
  kPositionError = 0,       ///< in W [m]
  kVelocityError = 3,       ///< in W [m/s]
  kAttitudeError = 6,       ///< in B [rad]
  kAccelerometerError = 9,  ///< of the bias, in B [m/s^2]
  kGyroError = 12,          ///< of the bias, in B [rad/s]
};

/// Noise of the IMU, each axis, as densities of white noise. The same defaults as sim::ImuConfig,
/// which names their source.
struct ImuNoise {
  double accelerometer = 1.86e-3;    ///< [m/s^2/sqrt(Hz)]
  double gyro = 2.44e-4;             ///< [rad/s/sqrt(Hz)]
  double accelerometer_walk = 3e-3;  ///< of the bias [m/s^3/sqrt(Hz)]
  double gyro_walk = 1.94e-5;        ///< of the bias [rad/s^2/sqrt(Hz)]
};

/// Nominal state.
struct OwnState {
  double t = 0.0;                                                ///< [s]
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();                ///< [m]
  Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();                ///< [m/s]
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();      ///< B to W
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< in B [m/s^2]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< in B [rad/s]
};

/// Nominal state and the covariance of its error.
struct OwnBelief {
  OwnState state;
  OwnMatrix cov = OwnMatrix::Zero();
};

/// The nominal state `dt` >= 0 [s] later under the IMU's mean force and rate.
OwnState PropagateOwnState(const OwnState& state, const ImuSample& imu, double dt);

/// The upper nine rows of the derivative of the propagated error with respect to the error; the
/// lower six, those of the biases, are unity.
Eigen::Matrix<double, 9, kOwnErrors> OwnTransition(const OwnState& state, const ImuSample& imu,
                                                   double dt);

/// State and covariance `dt` >= 0 [s] later.
OwnBelief PropagateOwnBelief(const OwnBelief& belief, const ImuSample& imu, double dt,
                             const ImuNoise& noise);

/// The state with an error added.
OwnState AddOwnError(const OwnState& state, const OwnVector& error);

/// The error that added to `state` gives `truth`.
OwnVector OwnErrorBetween(const OwnState& state, const OwnState& truth);

/// Velocity in B, and its derivative with respect to the error.
Eigen::Vector3d OwnVelocityInB(const OwnState& state,
                               Eigen::Matrix<double, 3, kOwnErrors>* jacobian);

/// Heading [rad], and its derivative; zero where the body x axis is vertical.
double OwnHeading(const OwnState& state, Eigen::Matrix<double, 1, kOwnErrors>* jacobian);

/// What the accelerometer reads of a vehicle that hovers [m/s^2], and its derivative.
Eigen::Vector3d OwnHoverForce(const OwnState& state,
                              Eigen::Matrix<double, 3, kOwnErrors>* jacobian);

}  // namespace touchdown::estimation
