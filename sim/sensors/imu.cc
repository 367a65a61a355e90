// SPDX-License-Identifier: BSD-3-Clause
// IMU from two true states. Specific force: change of velocity over the interval less gravity, in
// the body frame at the interval's middle; rate: rotation vector over the interval's length.
// Noise: white of density s is s/sqrt(dt) per sample, a bias walks by s sqrt(dt) per sample (the
// model of Kalibr and of J. Sola, arXiv:1711.02508, appendix E).

#include "sim/sensors/imu.h"

#include <cmath>

#include "estimation/base/argument_check.h"
#include "estimation/base/rotation_vector.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {
namespace {

const ImuConfig& Checked(const ImuConfig& config) {
  estimation::CheckWithin("imu.rate_hz", config.rate_hz, 10.0, 1000.0);
  estimation::CheckWithin("imu.accelerometer_noise", config.accelerometer_noise, 0.0, 1.0);
  estimation::CheckWithin("imu.gyro_noise", config.gyro_noise, 0.0, 0.1);
  estimation::CheckWithin("imu.accelerometer_walk", config.accelerometer_walk, 0.0, 1.0);
  estimation::CheckWithin("imu.gyro_walk", config.gyro_walk, 0.0, 0.1);
  estimation::CheckWithin("imu.accelerometer_offset", config.accelerometer_offset, 0.0, 2.0);
  estimation::CheckWithin("imu.gyro_offset", config.gyro_offset, 0.0, 0.2);
  return config;
}

}  // namespace

Imu::Imu(const ImuConfig& config, std::uint64_t seed)
    : config_(Checked(config)),
      clock_(config.rate_hz),
      noise_(seed, "imu noise"),
      bias_(seed, "imu bias"),
      accelerometer_bias_(bias_.Normal3(config.accelerometer_offset)),
      gyro_bias_(bias_.Normal3(config.gyro_offset)) {}

std::optional<estimation::ImuSample> Imu::Poll(const estimation::VehicleState& vehicle) {
  if (!clock_.Due(vehicle.t)) return std::nullopt;
  if (!last_.has_value() || !(vehicle.t > last_->t)) {
    last_ = vehicle;
    return std::nullopt;
  }
  const double dt = vehicle.t - last_->t;
  const double root = std::sqrt(dt);
  const Eigen::Vector3d phi =
      estimation::LogRotation(last_->q_WB.conjugate() * vehicle.q_WB);  // in B
  const Eigen::Quaterniond q_middle = last_->q_WB * estimation::ExpRotation(0.5 * phi);
  const Eigen::Vector3d force_W =
      (vehicle.v_WB - last_->v_WB) / dt + Eigen::Vector3d(0.0, 0.0, estimation::kGravity);

  estimation::ImuSample sample;
  sample.t = vehicle.t;
  sample.f_B = q_middle.conjugate() * force_W + accelerometer_bias_;
  sample.f_B += noise_.Normal3(config_.accelerometer_noise / root);
  sample.w_WB_B = phi / dt + gyro_bias_;
  sample.w_WB_B += noise_.Normal3(config_.gyro_noise / root);
  accelerometer_bias_ += bias_.Normal3(config_.accelerometer_walk * root);
  gyro_bias_ += bias_.Normal3(config_.gyro_walk * root);
  last_ = vehicle;
  return sample;
}

}  // namespace touchdown::sim
