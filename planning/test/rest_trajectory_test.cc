// SPDX-License-Identifier: BSD-3-Clause
// Braking and climbing trajectories: they start where they must, end at rest and keep the limits.

#include "touchdown/planning/spline/rest_trajectory.h"

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

TEST(RestTrajectory, JoinsTheStartKeepsTheLimitsAndEndsAtRest) {
  Draw draw(61);
  const Limits limits;
  for (int trial = 0; trial < 200; ++trial) {
    const bool speeds_up = trial % 4 == 3;  // may be bound to exceed its limits for a while
    const SplineState start = draw.State(10.0, 1.6, speeds_up ? 3.0 : 0.8);
    const Eigen::Vector3d shift(0, 0, trial % 2 ? 1.5 : 0.0);
    const UniformBspline curve = MakeRestTrajectory(start, 4.0, shift, limits);
    const SplineState first = curve.AtKnot(0), last = curve.AtKnot(curve.segments());
    EXPECT_LT((first.p - start.p).norm(), 1e-9);
    EXPECT_LT((first.v - start.v).norm(), 1e-9);
    EXPECT_LT((first.a - start.a).norm(), 1e-7);
    EXPECT_LT(last.v.norm(), 1e-9);
    EXPECT_LT(last.a.norm(), 1e-7);
    const DerivativeBounds bounds = BoundDerivatives(curve);
    const double allowed = speeds_up ? 1.25 : 1.0 + 1e-9;
    EXPECT_LE(bounds.speed, allowed * limits.speed);
    EXPECT_LE(bounds.acceleration, allowed * limits.acceleration);
    EXPECT_LE(bounds.body_rate, allowed * limits.body_rate);
  }
}

TEST(RestTrajectory, BrakingDistanceIsOfTheRightSize) {
  const SplineState start{{0, 0, 2}, {3, 0, 0}, {0, 0, 0}};
  const UniformBspline curve = MakeRestTrajectory(start, 0.0, Eigen::Vector3d::Zero(), {3.0, 6.0});
  const double distance = curve.Evaluate(curve.t_end()).p_WB.x();
  EXPECT_GT(distance, 9.0 / (2 * 6.0));  // no faster than the limit
  EXPECT_LT(distance, 2.0 * 9.0 / (2 * 6.0));
}

}  // namespace
}  // namespace touchdown::planning
