// SPDX-License-Identifier: BSD-3-Clause
// Identities of the uniform cubic B-spline: partition of unity, derivatives, reproduction of
// cubics, hull bounds.

#include "touchdown/planning/spline/uniform_bspline.h"

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/planning/spline/boundary_lift.h"
#include "touchdown/planning/spline/flatness.h"

namespace touchdown::planning {
namespace {

UniformBspline RandomCurve(Draw* draw, int points) {
  ControlPoints q(3, points);
  for (int i = 0; i < points; ++i) q.col(i) = draw->Vector(5.0);
  return {q, draw->Uniform(0.1, 0.6), draw->Uniform(-5.0, 5.0)};
}

TEST(UniformBspline, IsAffineInvariant) {
  Draw draw(1);
  for (int trial = 0; trial < 50; ++trial) {
    const UniformBspline curve = RandomCurve(&draw, 9);
    const Eigen::Vector3d shift = draw.Vector(10.0);
    const UniformBspline moved((3.0 * curve.control_points()).colwise() + shift, curve.interval(),
                               curve.t0());
    const double t = draw.Uniform(curve.t0(), curve.t_end());
    EXPECT_LT((moved.Evaluate(t).p_WB - 3.0 * curve.Evaluate(t).p_WB - shift).norm(), 1e-12);
    EXPECT_LT((moved.Evaluate(t).j_WB - 3.0 * curve.Evaluate(t).j_WB).norm(), 1e-9);
  }
}

TEST(UniformBspline, ThePositionAloneIsTheSame) {
  Draw draw(14);
  const UniformBspline curve = RandomCurve(&draw, 9);
  for (int i = 0; i < 200; ++i) {
    const double t = draw.Uniform(curve.t0() - 0.5, curve.t_end() + 0.5);
    EXPECT_LT((curve.Position(t) - curve.Evaluate(t).p_WB).norm(), 1e-12) << t;
  }
}

TEST(UniformBspline, DerivativesMatchDifferences) {
  Draw draw(2);
  for (int trial = 0; trial < 50; ++trial) {
    const UniformBspline curve = RandomCurve(&draw, 8);
    const double dt = 1e-5;
    const double t = draw.Uniform(curve.t0() + dt, curve.t_end() - dt);
    const FlatState minus = curve.Evaluate(t - dt), at = curve.Evaluate(t),
                    plus = curve.Evaluate(t + dt);
    EXPECT_LT(((plus.p_WB - minus.p_WB) / (2 * dt) - at.v_WB).norm(), 1e-5 * at.v_WB.norm() + 1e-4);
    EXPECT_LT(((plus.v_WB - minus.v_WB) / (2 * dt) - at.a_WB).norm(), 1e-1);
  }
}

TEST(UniformBspline, KnotsAgreeWithEvaluationFromBothSides) {
  Draw draw(3);
  const UniformBspline curve = RandomCurve(&draw, 10);
  for (int k = 0; k <= curve.segments(); ++k) {
    const SplineState knot = curve.AtKnot(k);
    const FlatState at = curve.Evaluate(curve.t0() + k * curve.interval());
    EXPECT_LT((knot.p - at.p_WB).norm(), 1e-12);
    EXPECT_LT((knot.v - at.v_WB).norm(), 1e-11);
    EXPECT_LT((knot.a - at.a_WB).norm(), 1e-9);
  }
}

TEST(UniformBspline, SquaredJerkIsTheIntegral) {
  Draw draw(12);
  const UniformBspline curve = RandomCurve(&draw, 10);
  double sum = 0.0;
  for (int k = 0; k < curve.segments(); ++k) {
    const double middle = curve.t0() + (k + 0.5) * curve.interval();
    sum += curve.Evaluate(middle).j_WB.squaredNorm() * curve.interval();
  }
  EXPECT_NEAR(curve.SquaredJerk(), sum, 1e-9 * sum);
}

TEST(UniformBspline, HermiteControlPointsReproduceCubics) {
  Draw draw(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector3d c0 = draw.Vector(1), c1 = draw.Vector(1), c2 = draw.Vector(1),
                          c3 = draw.Vector(1);
    const auto at = [&](double t) {
      return SplineState{c0 + t * c1 + t * t * c2 + t * t * t * c3,
                         c1 + 2 * t * c2 + 3 * t * t * c3, 2 * c2 + 6 * t * c3};
    };
    const double T = draw.Uniform(0.5, 4.0);
    const UniformBspline curve(HermiteControlPoints(at(0.0), at(T), 11, T), T / 11, 0.0);
    for (double t = 0.0; t <= T; t += 0.03) {
      EXPECT_LT((curve.Evaluate(t).p_WB - at(t).p).norm(), 1e-10);
    }
  }
}

TEST(UniformBspline, DerivativeBoundsHoldAlongTheCurve) {
  Draw draw(5);
  for (int trial = 0; trial < 50; ++trial) {
    const UniformBspline curve = RandomCurve(&draw, 12);
    const Eigen::Vector3d pull_W = 2.0 * Eigen::Vector3d::Random();
    const DerivativeBounds bounds = BoundDerivatives(curve, pull_W);
    double fastest = 0.0, strongest = 0.0, turning = 0.0;
    for (double t = curve.t0(); t <= curve.t_end(); t += 0.002) {
      fastest = std::max(fastest, curve.Evaluate(t).v_WB.norm());
      strongest = std::max(strongest, curve.Evaluate(t).a_WB.norm());
      FlatState against_the_pull = curve.Evaluate(t);
      against_the_pull.a_WB -= pull_W;
      const FlatInputs inputs = InvertFlatness(against_the_pull);
      const double thrust =
          (against_the_pull.a_WB + estimation::kGravity * Eigen::Vector3d::UnitZ()).norm();
      const double weaker = std::max(1.0, estimation::kGravity / thrust);
      turning = std::max(turning, weaker * inputs.w_WB_B.head<2>().norm());
    }
    EXPECT_LE(turning, bounds.body_rate + 1e-9);
    if (bounds.body_rate < 20.0) {  // near to free fall it is too short a moment to be met
      EXPECT_GE(turning, 0.9 * bounds.body_rate);
    }
    EXPECT_LE(fastest, bounds.speed + 1e-9);
    EXPECT_LE(strongest, bounds.acceleration + 1e-9);
    EXPECT_GE(strongest, 0.95 * bounds.acceleration);  // the acceleration's hull is attained
  }
}

TEST(UniformBspline, RefusesWhatIsNoSpline) {
  EXPECT_THROW(UniformBspline(ControlPoints::Zero(3, 3), 0.1, 0.0), std::invalid_argument);
  EXPECT_THROW(UniformBspline(ControlPoints::Zero(3, 4), 0.0, 0.0), std::invalid_argument);
  ControlPoints bad = ControlPoints::Zero(3, 4);
  bad(1, 2) = std::nan("");
  EXPECT_THROW(UniformBspline(bad, 0.1, 0.0), std::invalid_argument);
}

TEST(UniformBspline, HasNoKnotBeyondItsEndsAndNoPlaceAtNoTime) {
  const UniformBspline curve(ControlPoints::Random(3, 9), 0.2, 1.0);
  EXPECT_THROW(curve.AtKnot(-1), std::invalid_argument);
  EXPECT_NO_THROW(curve.AtKnot(curve.segments()));
  EXPECT_THROW(curve.AtKnot(curve.segments() + 1), std::invalid_argument);
  const double nan = std::nan("");
  EXPECT_TRUE(curve.Position(nan).array().isNaN().all());
  for (const FlatState& state : {curve.Evaluate(nan), curve.EvaluateOnward(nan)}) {
    for (const Eigen::Vector3d& part : {state.p_WB, state.v_WB, state.a_WB}) {
      EXPECT_TRUE(part.array().isNaN().all());
    }
  }
  const double endless = std::numeric_limits<double>::infinity();
  EXPECT_EQ(curve.Position(-endless), curve.Position(1.0));
  EXPECT_EQ(curve.Position(endless), curve.Position(curve.t_end()));
}

}  // namespace
}  // namespace touchdown::planning
