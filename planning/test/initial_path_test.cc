// SPDX-License-Identifier: BSD-3-Clause
#include "planning/baselines/ego/initial_path.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

TEST(PolynomialPath, HasThePublishedSamples) {
  // L = 7.5: T = (7.5 - 4/3)/2 + 4/3 = 4.4167 s, sampled at 0, 0.24 .. 4.32: N = 21, 4.32 s.
  EgoOptions options;
  EgoEnds ends;
  ends.start.v = {0.8, 0, 0};
  ends.p_end = {7.5, 0, 0};
  ends.v_end = {2.0, 0, 0};
  const auto path = PolynomialPath(ends, options, nullptr, 0);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->interval, 0.24, 1e-12);
  EXPECT_EQ(path->points.size(), 19u);
  EXPECT_GT((path->points.back() - ends.p_end).norm(), 0.1);  // short of the end, as published
  ends.p_end = {0.5, 0, 0};
  ends.v_end.setZero();
  const auto near = PolynomialPath(ends, options, nullptr, 0);
  ASSERT_TRUE(near);
  EXPECT_GE(near->points.size(), 7u);
}

TEST(PolynomialPath, TheRandomOneWidensWithFailuresAndRepeats) {
  const EgoOptions options;
  EgoEnds ends;
  ends.p_end = {7.5, 0, 0};
  const auto widest = [&](int failures) {
    double most = 0.0;
    EgoRandom random(3);
    for (int i = 0; i < 50; ++i) {
      const auto path = PolynomialPath(ends, options, &random, failures);
      for (const Vector3d& p : path->points) most = std::max(most, p.tail<2>().norm());
    }
    return most;
  };
  EXPECT_LT(widest(0), 0.01);
  EXPECT_GT(widest(1), 0.5);
  EXPECT_GT(widest(3), widest(1));
  EXPECT_EQ(widest(3), widest(3));
}

TEST(WarmPath, FollowsThePreviousCurveToTheNewEnd) {
  const EgoOptions options;
  EgoEnds ends;
  ends.p_end = {6, 0, 1};
  const UniformBspline previous(FitBspline(*PolynomialPath(ends, options, nullptr, 0)), 0.24, 10.0);
  ends.p_end = {7, 0.5, 1};
  const double t = 10.8;
  const auto path = WarmPath(previous, t, ends, options);
  ASSERT_TRUE(path);
  EXPECT_LT((path->points.front() - previous.Evaluate(t).p_WB).norm(), 1e-9);
  EXPECT_EQ(path->points.back(), ends.p_end);
  EXPECT_EQ(path->v_start, previous.Evaluate(t).v_WB);
  for (std::size_t i = 0; i + 2 < path->points.size(); ++i) {
    EXPECT_NEAR((path->points[i + 1] - path->points[i]).norm(), 0.4, 0.02);
  }
  // Nothing of it is left, and it ends where the plan shall.
  ends.p_end = previous.Evaluate(previous.t_end()).p_WB;
  EXPECT_FALSE(WarmPath(previous, 100.0, ends, options));
}

TEST(PolynomialPath, GivesUpWhereNoSamplingSuits) {
  EgoEnds ends;
  ends.start.v = {1e6, 0, 0};
  ends.p_end = {7.5, 0, 0};
  EXPECT_FALSE(PolynomialPath(ends, {}, nullptr, 0));
}

}  // namespace
}  // namespace touchdown::planning
