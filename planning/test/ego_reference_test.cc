// SPDX-License-Identifier: BSD-3-Clause
#include "planning/baselines/ego/ego_reference.h"

#include <gtest/gtest.h>

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

TEST(EgoReference, ItsTargetIsAHorizonAwayAndThenTheGoal) {
  const EgoOptions options;
  EgoReference reference;
  const Vector3d goal(20, 0, 1), rest = Vector3d::Zero();
  reference.Set({0, 0, 1}, rest, goal, rest, options);
  const LocalTarget first = reference.Target({0, 0, 1}, options);
  EXPECT_GE(first.p.x(), 7.5);
  EXPECT_LT(first.p.x(), 8.0);
  EXPECT_GT(first.v.x(), 1.5);
  EXPECT_NEAR(first.v.y(), 0.0, 1e-9);
  for (double x = 1.0; x < 12.0; x += 1.0) reference.Target({x, 0, 1}, options);
  const LocalTarget last = reference.Target({14, 0, 1}, options);
  EXPECT_EQ(last.p, goal);
  EXPECT_EQ(last.v, rest);
  // A vehicle that has lost the reference is given the old target.
  EXPECT_EQ(reference.Target({14, 30, 1}, options).p, goal);

  const Vector3d moving(0.8, 0, 0);
  reference.Set({0, 0, 1}, rest, {5, 0, 1}, moving, options);
  EXPECT_EQ(reference.Target({0, 0, 1}, options).v, moving);
}

}  // namespace
}  // namespace touchdown::planning
