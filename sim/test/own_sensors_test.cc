// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/own_sensors.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace touchdown::sim {
namespace {

TEST(OwnSensors, NoiseHasTheStatedSpread) {
  OwnSensorsConfig config;
  config.odometry = {20.0, 0.03, 0.0, 10.0, 0.0};
  OwnSensors sensors(config, 3);
  estimation::VehicleState state;
  state.p_WB = {1.0, 2.0, 3.0};
  state.v_WB = {1.0, 0.0, 0.0};
  state.q_WB = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  double level = 0.0, vertical = 0.0, velocity = 0.0, height = 0.0, heading = 0.0;
  int fixes = 0, speeds = 0, heights = 0, headings = 0;
  const Eigen::Vector3d v_B = state.q_WB.conjugate() * state.v_WB;
  for (int k = 0; k < 100000; ++k) {
    state.t = 0.01 * k;
    sensors.Sample(state);
    while (const auto fix = sensors.PollPosition(state.t)) {
      EXPECT_NEAR(state.t - fix->t, 0.1, 1e-6);
      EXPECT_EQ(fix->sigma_horizontal, 0.02);
      EXPECT_EQ(fix->sigma_vertical, 0.04);
      level += (fix->p_WB - state.p_WB).head<2>().squaredNorm() / 2.0;
      vertical += std::pow(fix->p_WB.z() - 3.0, 2);
      ++fixes;
    }
    while (const auto fix = sensors.PollVelocity(state.t)) {
      velocity += (fix->v_WB_B - v_B).squaredNorm() / 3.0;
      ++speeds;
    }
    while (const auto sample = sensors.PollHeight(state.t)) {
      height += std::pow(sample->height - 3.0, 2);
      ++heights;
    }
    while (const auto sample = sensors.PollHeading(state.t)) {
      heading += std::pow(sample->yaw - 0.5, 2);
      ++headings;
    }
  }
  EXPECT_NEAR(fixes, 10000, 2);
  EXPECT_NEAR(speeds, 20000, 2);
  EXPECT_NEAR(heights, 25000, 2);
  EXPECT_NEAR(headings, 25000, 2);
  EXPECT_NEAR(std::sqrt(level / fixes), 0.02, 0.001);
  EXPECT_NEAR(std::sqrt(vertical / fixes), 0.04, 0.002);
  EXPECT_NEAR(std::sqrt(velocity / speeds), 0.03, 0.001);
  EXPECT_NEAR(std::sqrt(height / heights), 0.1, 0.003);
  EXPECT_NEAR(std::sqrt(heading / headings), 0.035, 0.001);
}

TEST(OwnSensors, DriftHasItsSpreadAndItsMemory) {
  const OwnSensorConfig config{10.0, 0.0, 0.5, 2.0, 0.0};
  OwnNoise noise(config, 4, "test");
  EXPECT_EQ(noise.Claimed(), 0.5);
  double square = 0.0;
  double product = 0.0;  // of values one time constant apart
  Eigen::Vector3d past[20];
  const int n = 200000;
  for (int k = 0; k < n; ++k) {
    const Eigen::Vector3d error = noise.Draw();
    square += error.squaredNorm() / (3.0 * n);
    if (k >= 20) product += error.dot(past[k % 20]) / (3.0 * n);
    past[k % 20] = error;
  }
  EXPECT_NEAR(std::sqrt(square), 0.5, 0.02);
  EXPECT_NEAR(product / square, std::exp(-1.0), 0.05);
}

TEST(OwnSensors, RateZeroIsOff) {
  OwnSensorsConfig config;
  config.gps.sensor.rate_hz = 0.0;
  OwnSensors sensors(config, 3);
  estimation::VehicleState state;
  for (int k = 0; k < 1000; ++k) {
    state.t = 0.002 * k;
    sensors.Sample(state);
    EXPECT_FALSE(sensors.PollPosition(state.t).has_value());
    EXPECT_FALSE(sensors.PollVelocity(state.t).has_value());
  }
}

TEST(OwnSensors, OutageAndOutliersLeaveTheOtherFixesAsTheyAre) {
  OwnSensorsConfig config;
  config.gps.sensor.latency_ms = 0.0;
  OwnSensors sound(config, 3);
  config.gps.outage_begin = 40.0;
  config.gps.outage_length = 2.0;
  config.gps.outlier_probability = 0.1;
  OwnSensors faulty(config, 3);
  estimation::VehicleState state;
  int missing = 0;
  int outliers = 0;
  for (int k = 0; k < 1000; ++k) {
    state.t = 0.1 * k;
    sound.Sample(state);
    faulty.Sample(state);
    const auto good = sound.PollPosition(state.t);
    const auto fix = faulty.PollPosition(state.t);
    ASSERT_TRUE(good.has_value());
    if (!fix.has_value()) {
      EXPECT_GT(state.t, 39.99);
      EXPECT_LT(state.t, 42.0);
      ++missing;
      continue;
    }
    const double off = (fix->p_WB - good->p_WB).norm();
    if (off > 0.0) {
      EXPECT_NEAR(off, 5.0, 1e-9);
      ++outliers;
    }
  }
  EXPECT_EQ(missing, 20);
  EXPECT_NEAR(outliers, 98, 30);
}

TEST(OwnSensors, RefusesBadConfigurations) {
  OwnSensorsConfig config;
  config.gps.sensor.latency_ms = 501.0;
  EXPECT_THROW(OwnSensors(config, 1), std::invalid_argument);
  config = {};
  config.height.sigma = -0.1;
  EXPECT_THROW(OwnSensors(config, 1), std::invalid_argument);
  config = {};
  config.gps.outlier_probability = 1.1;
  EXPECT_THROW(OwnSensors(config, 1), std::invalid_argument);
  config = {};
  config.gps.vertical_factor = 11.0;
  EXPECT_THROW(OwnSensors(config, 1), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
