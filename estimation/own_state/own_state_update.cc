// SPDX-License-Identifier: BSD-3-Clause
// Corrections of the own-state filter: the start from a hover, and Kalman updates in Joseph form
// behind a Mahalanobis gate. The error is injected into the nominal state, and the covariance is
// turned to the new attitude (J. Sola, arXiv:1711.02508, chapter 6, eq. 285 to 287). The start
// levels the vehicle with the mean specific force of the hover. That force is then a Kalman update
// of a wide belief. So the correlation of tilt and accelerometer bias, which a hover cannot
// separate, is right from the first moment.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include "estimation/base/rotation_vector.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/own_state/own_state_filter.h"

namespace touchdown::estimation {
namespace {

// False, and no change, beyond the gate.
template <int M>
bool Update(OwnBelief& belief, const Eigen::Matrix<double, M, 1>& innovation,
            const Eigen::Matrix<double, M, kOwnErrors>& H, const Eigen::Matrix<double, M, 1>& sigma,
            double gate) {
  const Eigen::Matrix<double, M, M> R = sigma.array().square().matrix().asDiagonal();
  const Eigen::Matrix<double, M, kOwnErrors> HP = H * belief.cov;
  const Eigen::Matrix<double, M, M> S = HP * H.transpose() + R;
  const Eigen::LLT<Eigen::Matrix<double, M, M>> factor(S);
  if (factor.info() != Eigen::Success) return false;
  if (!(innovation.dot(factor.solve(innovation)) <= gate)) return false;

  const Eigen::Matrix<double, kOwnErrors, M> gain = factor.solve(HP).transpose();
  const OwnMatrix keep = OwnMatrix::Identity() - gain * H;
  const OwnMatrix kept = keep * belief.cov;
  OwnMatrix cov = kept * keep.transpose() + gain * R * gain.transpose();

  const OwnVector error = gain * innovation;
  belief.state = AddOwnError(belief.state, error);
  const Eigen::Matrix3d turn =
      Eigen::Matrix3d::Identity() - Skew(0.5 * error.segment<3>(kAttitudeError));
  cov.middleRows<3>(kAttitudeError) = (turn * cov.middleRows<3>(kAttitudeError)).eval();
  cov.middleCols<3>(kAttitudeError) = (cov.middleCols<3>(kAttitudeError) * turn.transpose()).eval();
  belief.cov = 0.5 * (cov + cov.transpose());
  return true;
}

constexpr double kNoGate = std::numeric_limits<double>::infinity();

}  // namespace

bool OwnStateFilter::Correct(const Input& measured, OwnBelief& belief) const {
  const OwnState& state = belief.state;
  Eigen::Matrix<double, 3, kOwnErrors> H = Eigen::Matrix<double, 3, kOwnErrors>::Zero();
  Eigen::Matrix<double, 1, kOwnErrors> h = Eigen::Matrix<double, 1, kOwnErrors>::Zero();
  using Scalar = Eigen::Matrix<double, 1, 1>;
  const Scalar sigma(measured.sigma.x());
  switch (measured.kind) {
    case Kind::kPosition:
      H.block<3, 3>(0, kPositionError).setIdentity();
      return Update<3>(belief, measured.value - state.p_WB, H, measured.sigma, gate_[3]);
    case Kind::kVelocity: {
      const Eigen::Vector3d v_B = OwnVelocityInB(state, &H);
      return Update<3>(belief, measured.value - v_B, H, measured.sigma, gate_[3]);
    }
    case Kind::kHeight:
      h(kPositionError + 2) = 1.0;
      return Update<1>(belief, Scalar(measured.value.x() - state.p_WB.z()), h, sigma, gate_[1]);
    case Kind::kHeading: {
      const double yaw = OwnHeading(state, &h);
      return Update<1>(belief, Scalar(WrapAngle(measured.value.x() - yaw)), h, sigma, gate_[1]);
    }
    case Kind::kImu:
      break;
  }
  return false;
}

OwnUpdate OwnStateFilter::Measure(const Input& measured, Snapshot& state) const {
  OwnSensor sensor = OwnSensor::kPosition;
  if (measured.kind == Kind::kVelocity) sensor = OwnSensor::kVelocity;
  if (measured.kind == Kind::kHeight) sensor = OwnSensor::kHeight;
  if (measured.kind == Kind::kHeading) sensor = OwnSensor::kHeading;
  OwnDiagnostics::Sensor& counts = state.diagnostics.of(sensor);

  OwnUpdate update = OwnUpdate::kAccepted;
  if (!Correct(measured, state.belief)) {
    ++counts.gated;
    ++counts.gated_in_row;
    const bool reset =
        sensor == OwnSensor::kPosition && counts.gated_in_row >= options_.reset_after;
    if (!reset) return OwnUpdate::kGated;
    // So many cannot all be outliers: the belief is wrong. Position comes from the fix, velocity as
    // at a start. Attitude and biases stay: the fix says less about them.
    update = OwnUpdate::kReset;
    ++state.diagnostics.resets;
    OwnBelief& belief = state.belief;
    belief.state.p_WB = measured.value;
    belief.cov.topRows<6>().setZero();
    belief.cov.leftCols<6>().setZero();
    belief.cov.diagonal().segment<3>(kPositionError) = measured.sigma.array().square();
    const double velocity = std::max(options_.prior.velocity, options_.usable_velocity);
    belief.cov.diagonal().segment<3>(kVelocityError).setConstant(velocity * velocity);
  }
  ++counts.accepted;
  counts.gated_in_row = 0;
  counts.last_t = measured.t;
  return update;
}

OwnUpdate OwnStateFilter::Keep(const Input& added) {
  if (added.kind == Kind::kPosition) hover_.position = added;
  if (added.kind == Kind::kHeading) hover_.heading = added;
  return OwnUpdate::kWaiting;
}

OwnUpdate OwnStateFilter::Align(const ImuSample& sample) {
  if (!has_imu_) hover_.begin = sample.t;
  has_imu_ = true;
  last_imu_ = sample;
  hover_.force += sample.f_B;
  hover_.rate += sample.w_WB_B;
  ++hover_.samples;
  const bool long_enough = sample.t - hover_.begin >= options_.hover_time;
  if (!long_enough || !hover_.position || !hover_.heading) return OwnUpdate::kWaiting;

  const Hover hover = hover_;
  const Eigen::Vector3d f_B = hover.force / hover.samples;
  if (!(f_B.norm() > 0.5 * kGravity)) {  // falls: no hover to start from
    hover_ = Hover{};
    hover_.begin = sample.t;
    return OwnUpdate::kWaiting;
  }
  // Level: the shortest turn that puts the force upright, then the heading about the vertical.
  OwnBelief belief;
  OwnState& state = belief.state;
  state.t = sample.t;
  const auto level = ShortestTurn(f_B, Eigen::Vector3d::UnitZ());
  const double turn = hover.heading->value.x() - Yaw(level);
  state.q_WB = (ExpRotation(turn * Eigen::Vector3d::UnitZ()) * level).normalized();
  state.p_WB = hover.position->value;

  const OwnStartSigma& prior = options_.prior;
  const double age = sample.t - hover.position->t;
  auto diagonal = belief.cov.diagonal();
  diagonal.segment<3>(kPositionError) =
      hover.position->sigma.array().square() + std::pow(prior.velocity * age, 2);
  diagonal.segment<3>(kVelocityError).setConstant(prior.velocity * prior.velocity);
  diagonal.segment<3>(kAttitudeError).setConstant(0.25 * std::numbers::pi * std::numbers::pi);
  diagonal.segment<3>(kAccelerometerError).setConstant(prior.accelerometer * prior.accelerometer);
  diagonal.segment<3>(kGyroError).setConstant(prior.gyro * prior.gyro);

  Eigen::Matrix<double, 3, kOwnErrors> H;
  const Eigen::Vector3d expected = OwnHoverForce(state, &H);
  // Level already: only the force's covariance is wanted here, and its length, which is the bias
  // along the thrust axis.
  Update<3>(belief, f_B - expected, H, Eigen::Vector3d::Constant(options_.hover_acceleration),
            kNoGate);
  H.setZero();
  H.block<3, 3>(0, kGyroError).setIdentity();
  Update<3>(belief, hover.rate / hover.samples - belief.state.gyro_bias, H,
            Eigen::Vector3d::Constant(options_.hover_rate), kNoGate);
  Eigen::Matrix<double, 1, kOwnErrors> h;
  const double yaw = OwnHeading(belief.state, &h);
  Update<1>(belief, Eigen::Matrix<double, 1, 1>(WrapAngle(hover.heading->value.x() - yaw)), h,
            Eigen::Matrix<double, 1, 1>(hover.heading->sigma.x()), kNoGate);
  Begin(belief);
  return OwnUpdate::kStarted;
}

}  // namespace touchdown::estimation
