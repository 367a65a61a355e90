// SPDX-License-Identifier: BSD-3-Clause
#include "planning/baselines/ego/refinement.h"

#include <gtest/gtest.h>

#include "planning/baselines/ego/initial_path.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

TEST(StretchTime, KeepsTheWayAndTakesLonger) {
  const EgoOptions options;
  EgoEnds ends;
  ends.p_end = {7.5, 1.0, 0};
  const auto path = PolynomialPath(ends, options, nullptr, 0);
  const ControlPoints q = FitBspline(*path);
  const SampledPath same = StretchTime(q, path->interval, 1.0, *path);
  ASSERT_EQ(same.points.size(), path->points.size());
  EXPECT_NEAR(same.interval, path->interval, 1e-12);
  for (std::size_t k = 0; k < same.points.size(); ++k) {
    EXPECT_LT((same.points[k] - path->points[k]).norm(), 3e-3);
  }
  const SampledPath longer = StretchTime(q, path->interval, 1.3, *path);
  const int stretched = static_cast<int>(q.cols()) + 4 - 1 - 10;
  EXPECT_NEAR(longer.interval * (q.cols() - 3), path->interval * (q.cols() - 3 + 0.3 * stretched),
              1e-9);
  EXPECT_LT((longer.points.front() - same.points.front()).norm(), 1e-9);
  EXPECT_LT((longer.points.back() - same.points.back()).norm(), 1e-6);
  for (const Vector3d& p : longer.points) EXPECT_NEAR(p.y(), p.x() / 7.5, 1e-6);
}

TEST(CheckLimits, AreOfEachAxis) {
  EgoOptions options;
  ControlPoints q(3, 8);
  for (int i = 0; i < 8; ++i) q.col(i) = 0.24 * 2.0 * i * Vector3d(1, 1, 0);
  EXPECT_TRUE(CheckLimits(q, 0.24, options).feasible);  // 2.8 m/s in the norm
  const LimitExcess excess = CheckLimits(q, 0.2, options);
  EXPECT_FALSE(excess.feasible);
  EXPECT_NEAR(excess.ratio, 1.2, 1e-9);
}

}  // namespace
}  // namespace touchdown::planning
