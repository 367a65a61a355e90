// SPDX-License-Identifier: BSD-3-Clause
#include "planning/baselines/ego/quintic.h"

#include <vector>

#include <gtest/gtest.h>

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

TEST(QuinticChain, IsSmoothToTheFourthDerivativeAndMeetsItsPoints) {
  const SplineState start{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}}, end{{6, 2, 1}, {0, 0, 0}, {0, 0, 0}};
  const std::vector<Vector3d> points = {start.p, {2, 1, 0}, {4, 1, 1}, end.p};
  const QuinticChain chain = QuinticChain::Through(points, {2.0, 1.0, 2.0}, start, end);
  EXPECT_DOUBLE_EQ(chain.duration(), 5.0);
  EXPECT_LT((chain.At(2.0).p - points[1]).norm(), 1e-9);
  EXPECT_LT((chain.At(3.0).p - points[2]).norm(), 1e-9);
  EXPECT_LT((chain.At(0.0).a - start.a).norm(), 1e-9);
  EXPECT_LT((chain.At(5.0).v - end.v).norm(), 1e-9);
  const double step = 1e-3;
  for (const double t : {2.0, 3.0}) {
    const auto jerk = [&](double s) -> Vector3d {
      return (chain.At(s + step).a - chain.At(s - step).a) / (2.0 * step);
    };
    EXPECT_LT((chain.At(t + 1e-9).a - chain.At(t - 1e-9).a).norm(), 1e-6);
    EXPECT_LT((jerk(t + 2 * step) - jerk(t - 2 * step)).norm(), 0.1);
    const Vector3d snap_before = (jerk(t - step) - jerk(t - 3 * step)) / (2 * step);
    const Vector3d snap_after = (jerk(t + 3 * step) - jerk(t + step)) / (2 * step);
    EXPECT_LT((snap_after - snap_before).norm(), 0.2);
  }
}

}  // namespace
}  // namespace touchdown::planning
