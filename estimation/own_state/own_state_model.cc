// SPDX-License-Identifier: BSD-3-Clause
// Strapdown propagation of the nominal state and of the error covariance, after J. Sola, Quaternion
// kinematics for the error-state Kalman filter, arXiv:1711.02508, chapters 5 and 7 (local angular
// error). Over a step the force acts at the attitude of the step's middle. This inverts the reading
// of sim::Imu exactly, which is made the same way. With f and w the readings less their biases:
//   q' = q exp(w dt),  a = R(q exp(w dt / 2)) f + g,  v' = v + a dt,  p' = p + v dt + a dt^2 / 2
// The Jacobian is that of these equations.

#include "touchdown/estimation/own_state/own_state_model.h"

#include <cmath>

#include "estimation/base/rotation_vector.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::estimation {
namespace {

const Eigen::Vector3d kUp(0.0, 0.0, kGravity);

}  // namespace

OwnState PropagateOwnState(const OwnState& state, const ImuSample& imu, double dt) {
  const Eigen::Vector3d phi = (imu.w_WB_B - state.gyro_bias) * dt;
  const Eigen::Vector3d f_B = imu.f_B - state.accelerometer_bias;
  const Eigen::Vector3d a_W = state.q_WB * (ExpRotation(0.5 * phi) * f_B) - kUp;
  OwnState next = state;
  next.t = state.t + dt;
  next.p_WB += dt * state.v_WB + 0.5 * dt * dt * a_W;
  next.v_WB += dt * a_W;
  next.q_WB = (state.q_WB * ExpRotation(phi)).normalized();
  return next;
}

Eigen::Matrix<double, 9, kOwnErrors> OwnTransition(const OwnState& state, const ImuSample& imu,
                                                   double dt) {
  const Eigen::Vector3d phi = (imu.w_WB_B - state.gyro_bias) * dt;
  const Eigen::Vector3d f_B = imu.f_B - state.accelerometer_bias;
  const Eigen::Matrix3d R_WB = state.q_WB.toRotationMatrix();
  const Eigen::Matrix3d half = ExpRotation(0.5 * phi).toRotationMatrix();
  const Eigen::Matrix3d R_middle = R_WB * half;
  const Eigen::Matrix3d dv_dattitude = -dt * R_WB * Skew(half * f_B);
  const Eigen::Matrix3d dv_daccelerometer = -dt * R_middle;
  const Eigen::Matrix3d dv_dgyro = 0.5 * dt * dt * R_middle * Skew(f_B) * RightJacobian(0.5 * phi);

  Eigen::Matrix<double, 9, kOwnErrors> F = Eigen::Matrix<double, 9, kOwnErrors>::Zero();
  F.leftCols<9>().setIdentity();
  F.block<3, 3>(kPositionError, kVelocityError) = dt * Eigen::Matrix3d::Identity();
  F.block<3, 3>(kPositionError, kAttitudeError) = 0.5 * dt * dv_dattitude;
  F.block<3, 3>(kPositionError, kAccelerometerError) = 0.5 * dt * dv_daccelerometer;
  F.block<3, 3>(kPositionError, kGyroError) = 0.5 * dt * dv_dgyro;
  F.block<3, 3>(kVelocityError, kAttitudeError) = dv_dattitude;
  F.block<3, 3>(kVelocityError, kAccelerometerError) = dv_daccelerometer;
  F.block<3, 3>(kVelocityError, kGyroError) = dv_dgyro;
  F.block<3, 3>(kAttitudeError, kAttitudeError) = ExpRotation(-phi).toRotationMatrix();
  F.block<3, 3>(kAttitudeError, kGyroError) = -dt * RightJacobian(phi);
  return F;
}

OwnBelief PropagateOwnBelief(const OwnBelief& belief, const ImuSample& imu, double dt,
                             const ImuNoise& noise) {
  const Eigen::Matrix<double, 9, kOwnErrors> F = OwnTransition(belief.state, imu, dt);
  OwnBelief next;
  next.state = PropagateOwnState(belief.state, imu, dt);
  const Eigen::Matrix<double, 9, kOwnErrors> FP = F * belief.cov;
  const Eigen::Matrix<double, 9, 9> upper = FP * F.transpose();
  next.cov.topLeftCorner<9, 9>() = 0.5 * (upper + upper.transpose());
  next.cov.topRightCorner<9, 6>() = FP.rightCols<6>();
  next.cov.bottomLeftCorner<6, 9>() = FP.rightCols<6>().transpose();
  next.cov.bottomRightCorner<6, 6>() = belief.cov.bottomRightCorner<6, 6>();
  auto diagonal = next.cov.diagonal();
  diagonal.segment<3>(kVelocityError).array() += noise.accelerometer * noise.accelerometer * dt;
  diagonal.segment<3>(kAttitudeError).array() += noise.gyro * noise.gyro * dt;
  diagonal.segment<3>(kAccelerometerError).array() +=
      noise.accelerometer_walk * noise.accelerometer_walk * dt;
  diagonal.segment<3>(kGyroError).array() += noise.gyro_walk * noise.gyro_walk * dt;
  return next;
}

OwnState AddOwnError(const OwnState& state, const OwnVector& error) {
  OwnState sum = state;
  sum.p_WB += error.segment<3>(kPositionError);
  sum.v_WB += error.segment<3>(kVelocityError);
  sum.q_WB = (state.q_WB * ExpRotation(error.segment<3>(kAttitudeError))).normalized();
  sum.accelerometer_bias += error.segment<3>(kAccelerometerError);
  sum.gyro_bias += error.segment<3>(kGyroError);
  return sum;
}

OwnVector OwnErrorBetween(const OwnState& state, const OwnState& truth) {
  OwnVector error;
  error << truth.p_WB - state.p_WB, truth.v_WB - state.v_WB,
      LogRotation(state.q_WB.conjugate() * truth.q_WB),
      truth.accelerometer_bias - state.accelerometer_bias, truth.gyro_bias - state.gyro_bias;
  return error;
}

Eigen::Vector3d OwnVelocityInB(const OwnState& state,
                               Eigen::Matrix<double, 3, kOwnErrors>* jacobian) {
  const Eigen::Matrix3d R_BW = state.q_WB.conjugate().toRotationMatrix();
  Eigen::Vector3d v_B = R_BW * state.v_WB;
  jacobian->setZero();
  jacobian->block<3, 3>(0, kVelocityError) = R_BW;
  jacobian->block<3, 3>(0, kAttitudeError) = Skew(v_B);
  return v_B;
}

double OwnHeading(const OwnState& state, Eigen::Matrix<double, 1, kOwnErrors>* jacobian) {
  const Eigen::Matrix3d R_WB = state.q_WB.toRotationMatrix();
  const Eigen::Vector3d x_B = R_WB.col(0);
  const double level2 = x_B.head<2>().squaredNorm();
  jacobian->setZero();
  if (level2 > 1e-6) {
    const Eigen::Matrix3d dx_B = -R_WB * Skew(Eigen::Vector3d::UnitX());
    jacobian->segment<3>(kAttitudeError) = (x_B.x() * dx_B.row(1) - x_B.y() * dx_B.row(0)) / level2;
  }
  return Yaw(state.q_WB);
}

Eigen::Vector3d OwnHoverForce(const OwnState& state,
                              Eigen::Matrix<double, 3, kOwnErrors>* jacobian) {
  const Eigen::Vector3d up_B = state.q_WB.conjugate() * kUp;
  jacobian->setZero();
  jacobian->block<3, 3>(0, kAttitudeError) = Skew(up_B);
  jacobian->block<3, 3>(0, kAccelerometerError).setIdentity();
  return up_B + state.accelerometer_bias;
}

}  // namespace touchdown::estimation
