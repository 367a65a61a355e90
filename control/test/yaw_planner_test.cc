// SPDX-License-Identifier: BSD-3-Clause
#include "control/tracking/yaw_planner.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "control/tracking/rate_profile.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::control {
namespace {

TEST(RateProfile, ArrivesWithoutOvershootForAnyStep) {
  for (double dt : {0.002, 0.02, 0.1}) {
    for (double distance : {0.001, 0.3, 5.0, -2.0}) {
      double left = distance;
      double rate = 0.0;
      for (int k = 0; k * dt < 20.0; ++k) {
        const RateStep step = StepTowards(left, rate, 0.8, 1.5, dt);
        EXPECT_LE(std::abs(step.rate - rate), 1.5 * dt + 1e-12);
        EXPECT_LE(std::abs(step.rate), 0.8 + 1e-12);
        left -= step.advance;
        rate = step.rate;
        // The last step may end past the point by the distance of one step.
        ASSERT_GE(std::copysign(left, left * distance), -1.5 * dt * dt / 8.0 - 1e-12) << dt;
      }
      EXPECT_NEAR(left, 0.0, 1e-4);
      EXPECT_NEAR(rate, 0.0, 1e-3);
    }
  }
}

TEST(YawPlanner, TurnsTheShortWayWithinLimits) {
  const YawLimits limits;
  YawState state{3.0, 0.0};
  const double dt = 0.02;
  double t = 0.0;
  while (!YawAligned(state.yaw, -3.0, 0.01) && t < 5.0) {
    const YawState next = StepYaw(state, -3.0, dt, limits);
    EXPECT_LE(std::abs(next.rate), limits.rate + 1e-12);
    EXPECT_LE(std::abs(next.rate - state.rate), limits.acceleration * dt + 1e-12);
    // The yaw is the integral of the rate.
    EXPECT_NEAR(estimation::WrapAngle(next.yaw - state.yaw), 0.5 * (state.rate + next.rate) * dt,
                1e-12);
    EXPECT_GE(next.rate, -1e-12);  // upwards through pi
    state = next;
    t += dt;
  }
  EXPECT_LT(t, 1.0);
}

TEST(YawPlanner, HalfTurnTakesItsTime) {
  YawState state;
  double t = 0.0;
  for (; !YawAligned(state.yaw, 3.1, 0.02) && t < 10.0; t += 0.01) {
    state = StepYaw(state, 3.1, 0.01);
  }
  // 3.1 rad at 2 rad/s with ramps of 0.5 s.
  EXPECT_NEAR(t, 3.1 / 2.0 + 0.5, 0.1);
}

TEST(YawPlanner, FuzzedTargetsNeverBreakTheLimits) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  const YawLimits limits{1.5, 3.0};
  YawState state;
  double desired = 0.0;
  for (int k = 0; k < 20000; ++k) {
    if (k % 37 == 0) desired = angle(random);
    const YawState next = StepYaw(state, desired, 0.01, limits);
    ASSERT_LE(std::abs(next.rate), limits.rate + 1e-12);
    ASSERT_LE(std::abs(next.rate - state.rate), limits.acceleration * 0.01 + 1e-12);
    state = next;
  }
}

TEST(YawPlanner, NoTargetBrakesToRest) {
  YawState state{0.3, 1.8};
  for (int k = 0; k < 100; ++k) {
    state = StepYaw(state, std::numeric_limits<double>::quiet_NaN(), 0.01);
  }
  EXPECT_NEAR(state.rate, 0.0, 1e-6);
  EXPECT_NEAR(state.yaw, 0.3 + 1.8 * 1.8 / 8.0, 0.02);
  EXPECT_THROW(StepYaw(state, 0.0, -0.01), std::invalid_argument);
  EXPECT_THROW(StepYaw(state, 0.0, 0.01, {0.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::control
