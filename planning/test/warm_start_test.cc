// SPDX-License-Identifier: BSD-3-Clause
#include "planning/problem/warm_start.h"

#include <limits>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

UniformBspline RandomSpline(int points, double h, Draw* draw) {
  ControlPoints q(3, points);
  for (int i = 0; i < points; ++i) q.col(i) = Eigen::Vector3d(i * h, 0, 0) + draw->Vector(0.5);
  return UniformBspline(q, h, draw->Uniform(-3.0, 8.0));
}

TEST(WarmStart, ShiftByNothingReproduces) {
  Draw draw(1);
  for (int trial = 0; trial < 50; ++trial) {
    const UniformBspline curve = RandomSpline(12, 0.3, &draw);
    const UniformBspline same =
        ShiftedSpline(curve, curve.t0(), curve.duration(), curve.segments());
    EXPECT_LT((same.control_points() - curve.control_points()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_DOUBLE_EQ(same.t0(), curve.t0());
  }
}

// Whole knots on, in the same time: the control points move up.
TEST(WarmStart, ShiftByKnotsMovesControlPointsUp) {
  Draw draw(2);
  const UniformBspline curve = RandomSpline(15, 0.25, &draw);
  const UniformBspline shifted =
      ShiftedSpline(curve, curve.t0() + 2 * 0.25, curve.duration() - 2 * 0.25, 10);
  const ControlPoints expected = curve.control_points().rightCols(13);
  EXPECT_LT((shifted.control_points() - expected).cwiseAbs().maxCoeff(), 1e-12);
}

// Another duration keeps the path: the same points, at a different pace.
TEST(WarmStart, RetimingKeepsThePath) {
  Draw draw(3);
  for (const double stretch : {0.5, 1.3, 2.0}) {
    const UniformBspline curve = RandomSpline(12, 0.3, &draw);
    const UniformBspline timed =
        ShiftedSpline(curve, curve.t0(), stretch * curve.duration(), curve.segments());
    EXPECT_NEAR(timed.duration(), stretch * curve.duration(), 1e-12);
    for (double s = 0.0; s <= 1.0; s += 0.01) {
      const FlatState a = curve.Evaluate(curve.t0() + s * curve.duration());
      const FlatState b = timed.Evaluate(timed.t0() + s * timed.duration());
      EXPECT_LT((a.p_WB - b.p_WB).norm(), 1e-12);
      EXPECT_LT((a.v_WB - stretch * b.v_WB).norm(), 1e-11);
    }
  }
}

// Knots that do not fall on the old ones: fourth order in the interval, on a smooth curve.
TEST(WarmStart, OtherKnotsFollowASmoothPath) {
  const int points = 40;
  const double h = 0.1;
  ControlPoints q(3, points);
  for (int i = 0; i < points; ++i) {
    q.col(i) = Eigen::Vector3d(i * h, std::sin(1.3 * i * h), std::cos(0.7 * i * h));
  }
  const UniformBspline curve(q, h, 0.0);
  const UniformBspline shifted = ShiftedSpline(curve, 0.137, curve.t_end() - 0.137, 29);
  for (double t = 0.137; t < curve.t_end(); t += 0.01) {
    EXPECT_LT((curve.Evaluate(t).p_WB - shifted.Evaluate(t).p_WB).norm(), 2e-4);
    EXPECT_LT((curve.Evaluate(t).v_WB - shifted.Evaluate(t).v_WB).norm(), 5e-3);
  }
  EXPECT_LT((curve.Evaluate(0.137).v_WB - shifted.Evaluate(0.137).v_WB).norm(), 1e-12);
}

// The new ends are met exactly, and a small step there stays small everywhere.
TEST(WarmStart, NewEndsAreMetWithoutAJolt) {
  Draw draw(5);
  for (int trial = 0; trial < 20; ++trial) {
    const UniformBspline curve = RandomSpline(20, 0.2, &draw);
    SplineState start = curve.AtKnot(0);
    SplineState end = curve.AtKnot(curve.segments());
    start.p += draw.Vector(0.03);
    start.v += draw.Vector(0.05);
    end.p += draw.Vector(0.03);
    const UniformBspline moved = WithEnds(curve, start, end);
    EXPECT_LT((moved.AtKnot(0).p - start.p).norm(), 1e-12);
    EXPECT_LT((moved.AtKnot(0).v - start.v).norm(), 1e-11);
    EXPECT_LT((moved.AtKnot(0).a - start.a).norm(), 1e-10);
    EXPECT_LT((moved.AtKnot(moved.segments()).p - end.p).norm(), 1e-12);
    EXPECT_LT((moved.AtKnot(moved.segments()).v - end.v).norm(), 1e-11);
    for (int k = 0; k <= curve.segments(); ++k) {
      EXPECT_LT((moved.AtKnot(k).p - curve.AtKnot(k).p).norm(), 0.3);
      EXPECT_LT((moved.AtKnot(k).a - curve.AtKnot(k).a).norm(), 1.0);
    }
  }
}

TEST(WarmStart, PastTheEndItStandsThereAndNonsenseIsRefused) {
  Draw draw(4);
  const UniformBspline curve = RandomSpline(12, 0.3, &draw);
  const UniformBspline past = ShiftedSpline(curve, curve.t_end() + 1.0, 2.0, 8);
  EXPECT_LT((past.Evaluate(past.t0() + 1.0).p_WB - curve.Evaluate(curve.t_end()).p_WB).norm(),
            1e-12);
  EXPECT_LT(past.Evaluate(past.t0() + 1.0).v_WB.norm(), 1e-12);
  EXPECT_THROW(ShiftedSpline(curve, 0.0, 0.0, 8), std::invalid_argument);
  EXPECT_THROW(ShiftedSpline(curve, 0.0, 1.0, 0), std::invalid_argument);
  EXPECT_THROW(ShiftedSpline(curve, 0.0, std::numeric_limits<double>::infinity(), 8),
               std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
