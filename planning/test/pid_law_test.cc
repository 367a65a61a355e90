// SPDX-License-Identifier: BSD-3-Clause
// The baseline's law alone: limits, integral and refusals.
#include "planning/baselines/pid/pid_law.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDt = 0.02;  // [s]

PidError Behind(double distance, double pad_speed = 0.0) {
  PidError error;
  error.position = {distance, 0.0};
  error.pad_velocity = {pad_speed, 0.0};
  return error;
}

TEST(PidLaw, LeadsTowardsThePadWithItsVelocityFedForward) {
  PidGains gains;
  PidLaw law(gains);
  const Vector3d at_pad_speed(0.8, 0.0, 0.0);
  EXPECT_LT(law.Step(Behind(0.0, 0.8), 0.0, at_pad_speed, Limits{}, kDt).norm(), 1e-12);
  const double wanted = gains.proportional * 0.2 / gains.response;
  EXPECT_NEAR(law.Step(Behind(0.2, 0.8), 0.0, at_pad_speed, Limits{}, kDt).x(), wanted, 1e-12);
  PidError slow = Behind(0.0, 0.8);
  slow.velocity.x() = 0.3;
  law.Reset();
  EXPECT_NEAR(law.Step(slow, 0.0, at_pad_speed, Limits{}, kDt).x(),
              gains.derivative * 0.3 / gains.response, 1e-12);
}

TEST(PidLaw, KeepsTheLimitsWhateverItIsTold) {
  Draw draw(71);
  for (int trial = 0; trial < 50; ++trial) {
    const Limits limits{draw.Uniform(1.0, 5.0), draw.Uniform(1.0, 8.0)};
    PidLaw law(PidGains{});
    Vector3d v = Vector3d::Zero();
    for (int k = 0; k < 300; ++k) {
      PidError error;
      error.position = draw.Vector(20.0).head<2>();
      error.velocity = draw.Vector(5.0).head<2>();
      error.pad_velocity = draw.Vector(3.0).head<2>();
      const Vector3d a = law.Step(error, draw.Uniform(-3.0, 3.0), v, limits, kDt);
      EXPECT_LE(a.norm(), limits.acceleration + 1e-9);
      v += kDt * a;
      EXPECT_LE(v.norm(), limits.speed + 1e-9);
    }
    EXPECT_LE(law.integral().norm(), PidGains{}.integral_limit + 1e-12);
  }
}

TEST(PidLaw, TheIntegralStandsStillFarAwayAndWhereALimitCuts) {
  PidGains gains;
  gains.integral_zone = 100.0;
  PidLaw wide(gains), law(PidGains{});
  for (int k = 0; k < 500; ++k) {
    wide.Step(Behind(9.0), 0.0, Vector3d::Zero(), Limits{}, kDt);          // beyond the speed
    wide.Step(Behind(1.5), 0.0, Vector3d::Zero(), Limits{3.0, 0.5}, kDt);  // the acceleration
    law.Step(Behind(0.6), 0.0, Vector3d(0.6, 0.0, 0.0), Limits{}, kDt);    // out of its zone
  }
  EXPECT_EQ(wide.integral(), Vector2d::Zero());
  EXPECT_EQ(law.integral(), Vector2d::Zero());
}

TEST(PidLaw, TheIntegralIsBoundedAndForgottenOnRequest) {
  PidGains gains;
  gains.integral_limit = 0.2;
  PidLaw law(gains);
  for (int k = 0; k < 5000; ++k) law.Step(Behind(0.4), 0.0, Vector3d(0.4, 0, 0), Limits{}, kDt);
  EXPECT_NEAR(law.integral().norm(), 0.2, 1e-12);
  law.Reset();
  EXPECT_EQ(law.integral(), Vector2d::Zero());
}

TEST(PidLaw, GainsOutOfRangeAreRefused) {
  PidGains gains;
  gains.response = 0.0;
  EXPECT_THROW(PidLaw{gains}, std::invalid_argument);
  gains = {};
  gains.proportional = -1.0;
  EXPECT_THROW(PidLaw{gains}, std::invalid_argument);
  gains = {};
  gains.integral_limit = -1.0;
  EXPECT_THROW(PidLaw{gains}, std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
