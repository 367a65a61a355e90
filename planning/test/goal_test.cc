// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/replan/goal.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::planning {
namespace {

MovingGoal::Position Course(const Taylor& t) {
  return {2.0 + 0.4 * t, sin(0.5 * t) * exp(-0.1 * t) / (1.0 + t * t), sqrt(4.0 + cos(t)) - 0.3};
}

TEST(Goal, AFunctionsDerivativesAreExact) {
  const MovingGoal goal(Course);
  const double h = 1e-4;
  for (double t = -2.0; t < 4.0; t += 0.37) {
    const estimation::PadState at = goal.At(t), before = goal.At(t - h), after = goal.At(t + h);
    const auto slope = [&](Eigen::Vector3d estimation::PadState::*part) -> Eigen::Vector3d {
      return (after.*part - before.*part) / (2.0 * h);
    };
    EXPECT_LT((at.v_WP - slope(&estimation::PadState::p_WP)).norm(), 1e-7) << t;
    EXPECT_LT((at.a_WP - slope(&estimation::PadState::v_WP)).norm(), 1e-7) << t;
    EXPECT_LT((at.j_WP - slope(&estimation::PadState::a_WP)).norm(), 1e-7) << t;
    EXPECT_NEAR(at.p_WP.y(), std::sin(0.5 * t) * std::exp(-0.1 * t) / (1.0 + t * t), 1e-15) << t;
  }
}

TEST(Goal, WhatIsNoGoalSaysSo) {
  EXPECT_THROW(GoalAt({0.0, std::nan(""), 1.0}), std::invalid_argument);
  EXPECT_THROW(MovingGoal(nullptr), std::invalid_argument);
  const MovingGoal throws(
      [](const Taylor&) -> MovingGoal::Position { throw std::runtime_error("no way"); });
  EXPECT_TRUE(std::isnan(throws.At(1.0).p_WP.x()));
  const MovingGoal endless([](const Taylor& t) { return MovingGoal::Position{1.0 / t, 0.0, 1.0}; });
  EXPECT_TRUE(std::isnan(endless.At(0.0).p_WP.y())) << "all of it";
  EXPECT_EQ(endless.At(2.0).p_WP.x(), 0.5);
}

// A goal that stands is met at rest, one that moves with its velocity; neither has a deck.
TEST(Goal, IsFlownToAroundAWall) {
  OccupancyMap map = ObservedMap();
  for (double y = -1.0; y <= 1.0; y += 0.1) {
    for (double z = 0.05; z < 3.0; z += 0.1) map.SetOccupied({0.0, y, z});
  }
  const GoalAt stands({4.0, 0.5, 1.5});
  const MovingGoal moves([](const Taylor& t) {
    return MovingGoal::Position{3.0 + 0.6 * t, sin(0.3 * t), 1.5};
  });
  for (const estimation::PadPrediction* goal :
       {static_cast<const estimation::PadPrediction*>(&stands),
        static_cast<const estimation::PadPrediction*>(&moves)}) {
    Replanner replanner(ReplannerOptions{}, solvers::StandardBackends());
    ReplanInput input;
    input.t_start = 0.02;
    input.vehicle.p_WB = {-4.0, 0.0, 1.5};
    input.pad = goal;
    input.endpoint.height = 0.0;
    replanner.CommitHover(input.vehicle.p_WB, 0.0);
    const ReplanResult& plan = replanner.Replan(input, map);
    ASSERT_EQ(plan.status, ReplanStatus::kPlanned) << Explain(plan.reason);
    EXPECT_TRUE(plan.certificate.passed());
    const SplineState end = plan.curve.AtKnot(plan.curve.segments());
    const estimation::PadState at = goal->At(plan.curve.t_end());
    EXPECT_LT((end.p - at.p_WP).norm(), 1e-6);
    EXPECT_LT((end.v - at.v_WP).norm(), 1e-6);
  }
}

// The terms that ask for a way down to a deck, and for one that sees it, say nothing of a goal.
TEST(Goal, IsNotApproachedFromAbove) {
  const OccupancyMap map = ObservedMap();
  const GoalAt goal({1.0, 0.5, 1.5});
  ReplannerOptions options;
  for (const char* name : {"approach_corridor", "pad_visibility"}) {
    options.problem.settings.push_back({name, 300.0, std::nullopt, {}});
  }
  Replanner replanner(options, solvers::StandardBackends());
  ReplanInput input;
  input.t_start = 0.02;
  input.vehicle.p_WB = {-1.0, 0.0, 1.5};
  input.pad = &goal;
  input.endpoint.height = 0.0;
  replanner.CommitHover(input.vehicle.p_WB, 0.0);
  const ReplanResult& plan = replanner.Replan(input, map);
  ASSERT_EQ(plan.status, ReplanStatus::kPlanned) << Explain(plan.reason);
  for (double t = plan.curve.t0(); t < plan.curve.t_end(); t += 0.05) {
    EXPECT_NEAR(plan.curve.Position(t).z(), 1.5, 1e-6) << t;
  }
}

}  // namespace
}  // namespace touchdown::planning
