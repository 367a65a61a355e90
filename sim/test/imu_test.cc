// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/imu.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "estimation/base/rotation_vector.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/own_state/own_state_model.h"

namespace touchdown::sim {
namespace {

ImuConfig Exact() {
  ImuConfig config;
  config.accelerometer_noise = config.gyro_noise = 0.0;
  config.accelerometer_walk = config.gyro_walk = 0.0;
  config.accelerometer_offset = config.gyro_offset = 0.0;
  return config;
}

// Readings of a vehicle at rest, level.
std::vector<estimation::ImuSample> AtRest(const ImuConfig& config, double seconds) {
  Imu imu(config, 17);
  std::vector<estimation::ImuSample> samples;
  estimation::VehicleState state;
  const long steps = std::lround(seconds * config.rate_hz);
  for (long k = 0; k <= steps; ++k) {
    state.t = static_cast<double>(k) / config.rate_hz;
    if (const auto sample = imu.Poll(state)) samples.push_back(*sample);
  }
  return samples;
}

// Allan variance of force and rate at clusters of n samples, mean over the axes.
struct Allan {
  double force = 0.0;
  double rate = 0.0;
};
Allan AllanVariance(const std::vector<estimation::ImuSample>& samples, std::size_t n) {
  Allan variance;
  Eigen::Vector3d force[2];
  Eigen::Vector3d rate[2];
  const std::size_t clusters = samples.size() / n;
  for (std::size_t c = 0; c < clusters; ++c) {
    force[c % 2].setZero();
    rate[c % 2].setZero();
    for (std::size_t i = c * n; i < (c + 1) * n; ++i) {
      force[c % 2] += samples[i].f_B / static_cast<double>(n);
      rate[c % 2] += samples[i].w_WB_B / static_cast<double>(n);
    }
    if (c == 0) continue;
    const double by = 1.0 / (6.0 * static_cast<double>(clusters - 1));
    variance.force += by * (force[1] - force[0]).squaredNorm();
    variance.rate += by * (rate[1] - rate[0]).squaredNorm();
  }
  return variance;
}

TEST(Imu, HoverReadsGravityUpwards) {
  const auto samples = AtRest(Exact(), 0.1);
  ASSERT_EQ(samples.size(), 50U);  // the first call only remembers
  for (const auto& sample : samples) {
    EXPECT_LT((sample.f_B - Eigen::Vector3d(0.0, 0.0, estimation::kGravity)).norm(), 1e-12);
    EXPECT_LT(sample.w_WB_B.norm(), 1e-12);
  }
}

TEST(Imu, MeanIsTheBiasBesideGravity) {
  ImuConfig config = Exact();
  config.accelerometer_noise = 1.86e-3;
  config.gyro_noise = 2.44e-4;
  config.accelerometer_offset = 0.05;
  config.gyro_offset = 5e-3;
  const Imu imu(config, 17);  // the seed of AtRest
  const auto samples = AtRest(config, 100.0);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (const auto& sample : samples) {
    force += sample.f_B / static_cast<double>(samples.size());
    rate += sample.w_WB_B / static_cast<double>(samples.size());
  }
  force -= Eigen::Vector3d(0.0, 0.0, estimation::kGravity) + imu.accelerometer_bias();
  rate -= imu.gyro_bias();
  EXPECT_GT(imu.accelerometer_bias().norm(), 1e-3);
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 4.0 * config.accelerometer_noise / std::sqrt(100.0));
  EXPECT_LT(rate.cwiseAbs().maxCoeff(), 4.0 * config.gyro_noise / std::sqrt(100.0));
}

TEST(Imu, AllanVarianceOfWhiteNoiseIsItsDensitySquaredOverTime) {
  ImuConfig config;
  config.rate_hz = 250.0;
  config.accelerometer_walk = config.gyro_walk = 0.0;
  const auto samples = AtRest(config, 400.0);
  for (std::size_t n : {1U, 10U, 50U}) {
    const double tau = static_cast<double>(n) / config.rate_hz;
    const Allan variance = AllanVariance(samples, n);
    const double force = std::sqrt(variance.force * tau) / config.accelerometer_noise;
    const double rate = std::sqrt(variance.rate * tau) / config.gyro_noise;
    RecordProperty("force_" + std::to_string(n), std::to_string(force));
    RecordProperty("rate_" + std::to_string(n), std::to_string(rate));
    EXPECT_NEAR(force, 1.0, 0.05) << n;
    EXPECT_NEAR(rate, 1.0, 0.05) << n;
  }
}

TEST(Imu, AllanVarianceOfTheBiasIsThatOfAWalk) {
  ImuConfig config;
  config.rate_hz = 100.0;
  config.accelerometer_noise = config.gyro_noise = 0.0;
  const auto samples = AtRest(config, 2000.0);
  const double tau = 4.0;
  const Allan variance = AllanVariance(samples, 400);
  const double force = std::sqrt(variance.force * 3.0 / tau) / config.accelerometer_walk;
  const double rate = std::sqrt(variance.rate * 3.0 / tau) / config.gyro_walk;
  RecordProperty("force", std::to_string(force));
  RecordProperty("rate", std::to_string(rate));
  EXPECT_NEAR(force, 1.0, 0.12);
  EXPECT_NEAR(rate, 1.0, 0.12);
}

// The filter's propagation of the readings gives velocity and attitude to rounding, for any flight.
TEST(Imu, PropagationOfExactReadingsGivesTheStatesBack) {
  Imu imu(Exact(), 1);
  estimation::VehicleState state;
  estimation::OwnState own;
  for (int k = 0; k <= 1000; ++k) {
    const double t = 0.002 * k;
    state.t = t;
    state.v_WB = {std::sin(3.0 * t), std::cos(2.0 * t), 0.5 * std::sin(5.0 * t)};
    state.q_WB = estimation::ExpRotation({0.5 * std::sin(4.0 * t), 0.4 * t, std::sin(t)});
    const auto sample = imu.Poll(state);
    if (!sample) {
      own.v_WB = state.v_WB;
      own.q_WB = state.q_WB;
      continue;
    }
    own = PropagateOwnState(own, *sample, sample->t - own.t);
  }
  EXPECT_LT((own.v_WB - state.v_WB).norm(), 1e-9);
  EXPECT_LT(estimation::LogRotation(own.q_WB.conjugate() * state.q_WB).norm(), 1e-9);
}

TEST(Imu, SameSeedSameBitsAndNoiseDoesNotShiftTheBias) {
  ImuConfig quiet;
  quiet.accelerometer_noise = 0.0;
  const auto a = AtRest(ImuConfig{}, 1.0);
  const auto b = AtRest(ImuConfig{}, 1.0);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].f_B, b[i].f_B);
  EXPECT_EQ(Imu(quiet, 5).accelerometer_bias(), Imu(ImuConfig{}, 5).accelerometer_bias());
}

TEST(Imu, RefusesBadConfigurations) {
  ImuConfig config;
  config.rate_hz = 5.0;
  EXPECT_THROW(Imu(config, 1), std::invalid_argument);
  config = {};
  config.gyro_noise = -1.0;
  EXPECT_THROW(Imu(config, 1), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
