// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/timed_path.h"

#include <gtest/gtest.h>

namespace touchdown::planning {
namespace {

/// At 1 m/s along x at this y, from t = 0 on.
UniformBspline Along(double y, double x_from = -2.0, double x_to = 2.0) {
  constexpr int kPoints = 43;
  const double h = (x_to - x_from) / (kPoints - 3);
  ControlPoints points(3, kPoints);
  for (int i = 0; i < kPoints; ++i) points.col(i) << x_from + (i - 1) * h, y, 0.05;
  return UniformBspline(points, h, 0.0);
}

/// Along `curve`, past its only run by two sides of a triangle whose tip is `high` m beside.
TimedPath Around(const UniformBspline& curve, const BlockedRun& run, double high, double speed) {
  const Eigen::Vector3d in = curve.Position(run.t_in), out = curve.Position(run.t_out);
  TimedPath way;
  way.AddCurve(curve, 0.0, run.t_in);
  way.AddDetour(curve, run, {in, 0.5 * (in + out) + high * Eigen::Vector3d::UnitY(), out}, speed);
  way.AddCurve(curve, run.t_out, curve.t_end());
  return way;
}

TEST(TimedPath, IsTheCurveWhereItFollowsThat) {
  const UniformBspline curve = Along(1.5);
  TimedPath way;
  EXPECT_FALSE(way.known());
  way.AddCurve(curve, 0.5, curve.t_end());
  ASSERT_TRUE(way.known());
  EXPECT_EQ(way.t0(), 0.5);
  EXPECT_EQ(way.t_end(), curve.t_end());
  EXPECT_EQ(way.delay(), 0.0);
  EXPECT_TRUE(way.bound().empty());
  for (double t = 0.5; t < 4.0; t += 0.1) {
    EXPECT_NEAR((way.At(t) - curve.Position(t)).norm(), 0.0, 1e-9);
  }
  EXPECT_NEAR((way.AtShare(1.0) - curve.Position(curve.t_end())).norm(), 0.0, 1e-9);
  GuidePath path;
  way.Sample(1.0, 3.0, &path);
  EXPECT_NEAR((path.front() - curve.Position(1.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((path.back() - curve.Position(3.0)).norm(), 0.0, 1e-9);
  way.Sample(2.0, 2.0, &path);
  EXPECT_EQ(path.size(), 2u);
  way.Clear();
  EXPECT_FALSE(way.known());
}

TEST(TimedPath, ADetourTakesTheTimeOfWhatItIsLonger) {
  const UniformBspline curve = Along(0.0);
  const BlockedRun run = {1.5, 2.5, false, false};
  const TimedPath way = Around(curve, run, 1.0, 2.0);
  const double longer = 2.0 * std::hypot(0.5, 1.0) - 1.0;
  EXPECT_NEAR(way.delay(), longer / 2.0, 1e-6);
  EXPECT_NEAR(way.t_end(), curve.t_end() + way.delay(), 1e-12);
  ASSERT_EQ(way.bound().size(), 1u);
  EXPECT_NEAR(way.bound().front().from, run.t_in, 1e-12);
  EXPECT_NEAR(way.bound().front().to, run.t_out + way.delay(), 1e-12);
  EXPECT_NEAR(way.At(2.0 + 0.5 * way.delay()).y(), 1.0, 1e-6);
  EXPECT_NEAR(way.LengthOf(way.bound().front()), 2.0 * std::hypot(0.5, 1.0), 1e-6);
  EXPECT_EQ(way.TimeOf(1.0), 1.0);
  EXPECT_NEAR(way.TimeOf(2.0), 2.0 + 0.5 * way.delay(), 1e-12);
  EXPECT_NEAR(way.TimeOf(3.0), 3.0 + way.delay(), 1e-12);
  // Behind it the curve goes on, later.
  EXPECT_NEAR((way.At(3.5 + way.delay()) - curve.Position(3.5)).norm(), 0.0, 1e-6);
  // A shorter path is no earlier.
  const UniformBspline bent = Along(0.0);
  TimedPath straight;
  straight.AddDetour(bent, run, {bent.Position(1.5), bent.Position(2.0)}, 1.0);
  EXPECT_EQ(straight.delay(), 0.0);
}

TEST(TimedPath, IsSampledBetweenWhereItIsNearestToTwoPlaces) {
  const UniformBspline curve = Along(0.0);
  const TimedPath way = Around(curve, {1.5, 2.5, false, false}, 1.0, 1.0);
  GuidePath path;
  way.SampleBeside(Along(0.2, -0.25, 0.25), {0.0, 0.5, false, false}, &path);
  double highest = 0.0;
  for (const Eigen::Vector3d& p : path) highest = std::max(highest, p.y());
  EXPECT_NEAR(highest, 1.0, 1e-6);
  EXPECT_LT((path.front() - Eigen::Vector3d(-0.3, 0.4, 0.05)).norm(), 0.2);
  // A curve that goes the other way is led at the same shares of time.
  const UniformBspline reversed(curve.control_points().rowwise().reverse(), curve.interval(), 0.0);
  way.SampleBeside(reversed, {1.0, 2.0, false, false}, &path);
  EXPECT_NEAR((path.front() - way.AtShare(0.25)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((path.back() - way.AtShare(0.5)).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace touchdown::planning
