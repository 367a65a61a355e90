// SPDX-License-Identifier: BSD-3-Clause
// The limits under a steady pull, and that plans keep them.
#include "touchdown/planning/spline/limits.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

VehicleFacts Facts() {
  VehicleFacts facts;
  facts.thrust_max = 23.0;
  facts.tilt_max = 35.0 * std::acos(-1.0) / 180.0;
  return facts;
}

TEST(LimitsUnder, WithoutAPullTheyAreWhatTheyWere) {
  const Limits limits{2.0, 8.0};
  EXPECT_EQ(LimitsUnder(limits, Facts(), Vector3d::Zero()).acceleration, 8.0);
  EXPECT_EQ(LimitsUnder(limits, Facts(), Vector3d::Zero()).speed, 2.0);
}

// Lifted by a third of its weight it has less thrust to turn, and the same curve turns the axis faster.
TEST(LimitsUnder, APullUpMakesTheThrustAxisTurnFaster) {
  const Vector3d pull(0.0, 0.0, 3.3);
  const Limits under = LimitsUnder({3.0, 6.0}, Facts(), pull);
  const SplineState start{Vector3d::Zero(), {1.5, 0.0, -0.5}, Vector3d::Zero()};
  const UniformBspline light = MakeRestTrajectory(start, 0.0, Vector3d::Zero(), under);
  EXPECT_LE(BoundDerivatives(light, pull).body_rate, under.body_rate + 1e-6);
  EXPECT_GT(BoundDerivatives(light, pull).body_rate, 1.2 * BoundDerivatives(light).body_rate);
}

TEST(LimitsUnder, TiltIsSharedWithTheWind) {
  const double of_tilt = 9.81 * std::tan(Facts().tilt_max);  // 6.87 m/s^2
  const Limits under = LimitsUnder({3.0, 6.0}, Facts(), {0.0, -3.6, 0.0});
  EXPECT_NEAR(under.acceleration, of_tilt - 3.6, 1e-12);
  EXPECT_EQ(under.speed, 3.0);
  EXPECT_NEAR(under.braking_factor * under.acceleration, 6.0, 1e-12);
  // A little wind leaves the limit itself; a pull down means more thrust, which tilted gives more.
  EXPECT_EQ(LimitsUnder({3.0, 6.0}, Facts(), {0.5, 0.0, 0.0}).acceleration, 6.0);
  EXPECT_GT(LimitsUnder({3.0, 6.0}, Facts(), {3.6, 0.0, -1.0}).acceleration, under.acceleration);
}

// Stops count on what the tracking law's own tilt leaves, and on no more than plans may use in still air.
TEST(LimitsUnder, StopsAreCountedWithWhatTheTrackingLawHasLeft) {
  VehicleFacts facts = Facts();
  facts.stop_tilt_max = facts.tilt_max + 10.0 * std::acos(-1.0) / 180.0;
  const auto stopping = [&](double pull) {
    const Limits under = LimitsUnder({3.0, 6.0}, facts, {pull, 0.0, 0.0});
    return under.braking_factor * under.acceleration;
  };
  EXPECT_NEAR(stopping(3.0), 6.0, 1e-12);
  EXPECT_NEAR(stopping(5.0), 9.81 - 5.0, 0.01);
  EXPECT_NEAR(stopping(8.0), 9.81 - 8.0, 0.01);
}

TEST(LimitsUnder, ThrustIsSharedToo) {
  VehicleFacts weak = Facts();
  weak.thrust_max = 11.0;
  const Limits under = LimitsUnder({3.0, 6.0}, weak, {2.0, 0.0, 0.0});
  EXPECT_NEAR(under.acceleration, std::sqrt(11.0 * 11.0 - 9.81 * 9.81) - 2.0, 1e-12);
}

// Before, a third of the limit was always left: more than thrust and tilt had.
TEST(LimitsUnder, PlansTakeNoMoreThanTheTrackingLawHas) {
  VehicleFacts facts = Facts();
  facts.stop_tilt_max = facts.tilt_max + 10.0 * std::acos(-1.0) / 180.0;
  EXPECT_NEAR(LimitsUnder({3.0, 6.0}, facts, {6.0, 0.0, 0.0}).acceleration, 2.0, 1e-12);
  EXPECT_NEAR(LimitsUnder({3.0, 6.0}, facts, {8.5, 0.0, 0.0}).acceleration, 9.81 - 8.5, 0.01);
}

TEST(LimitsUnder, SomethingIsAlwaysLeft) {
  EXPECT_EQ(LimitsUnder({3.0, 6.0}, Facts(), {20.0, 0.0, 0.0}).acceleration, kLeastAcceleration);
  EXPECT_EQ(LimitsUnder({3.0, 6.0}, Facts(), {0.0, 0.0, 30.0}).acceleration, kLeastAcceleration);
}

// Any acceleration within what is left can be flown, in any horizontal direction.
TEST(LimitsUnder, WhatIsLeftCanBeFlown) {
  for (const Vector3d& pull : {Vector3d(3.0, 1.0, 0.4), Vector3d(-2.0, 2.5, -0.8)}) {
    const double a = LimitsUnder({3.0, 6.0}, Facts(), pull).acceleration;
    for (double angle = 0.0; angle < 6.3; angle += 0.1) {
      const Vector3d f = Vector3d(a * std::cos(angle), a * std::sin(angle), 9.81) - pull;
      EXPECT_LE(f.head<2>().norm(), std::tan(Facts().tilt_max) * f.z() + 1e-9);
      EXPECT_LE(f.norm(), Facts().thrust_max + 1e-9);
    }
  }
}

TEST(Replanner, PlansKeepWhatThePullLeaves) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 1.0, 0.3}, 0.8, 0.3, 0.1);
  const Vector3d start(-4.0, 0.0, 2.0);
  for (const double pull : {0.0, 3.5}) {
    Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
    replanner.CommitHover(start, 0.0);
    ReplanInput input = Input(start, pad, 0.0);
    input.pull_W.x() = pull;
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned);
    const double left =
        LimitsUnder(replanner.options().limits, replanner.options().problem.vehicle, input.pull_W)
            .acceleration;
    EXPECT_LE(result.certificate.acceleration_bound, left + 1e-6) << pull;
    double fastest = 0.0;
    for (double t = input.t_start; t < result.curve.t_end(); t += 0.01) {
      fastest = std::max(fastest, result.curve.Evaluate(t).a_WB.norm());
    }
    EXPECT_LE(fastest, left + 1e-6) << pull;
  }
}

TEST(Replanner, APullThatIsNoNumberIsInvalidInput) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 1.0, 0.3}, 0.8, 0.3, 0.1);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover({-4.0, 0.0, 2.0}, 0.0);
  ReplanInput input = Input({-4.0, 0.0, 2.0}, pad, 0.0);
  input.pull_W.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(replanner.Replan(input, map).reason, ReplanReason::kInvalidInput);
}

}  // namespace
}  // namespace touchdown::planning
