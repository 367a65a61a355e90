// SPDX-License-Identifier: BSD-3-Clause
// The evaluator counts, caches, stops and keeps the best feasible point.

#include "touchdown/solvers/backend/evaluator.h"

#include <gtest/gtest.h>

#include "solvers/test/test_terms.h"

namespace touchdown::solvers {
namespace {

/// min (x - 3)^2 subject to x <= 1 as a row.
struct Bounded {
  Bounded() : problem({.blocks = 1, .block_size = 1}) {
    problem.AddTerm(SumOfSquares<1, 1>(
                        "distance", [](const auto* x, auto* u) { u[0] = x[0] - 3.0; }, true),
                    Role::kCost);
    const auto row = [](const auto* x, auto* u) { u[0] = x[0] - 1.0; };
    using Map = WholeMap<1, 1, decltype(row)>;
    problem.AddTerm(std::make_shared<WindowTerm<Map, HingeLoss>>(
                        TermInfo{"bound", "", "", "", true}, Map(row), HingeLoss(1.0, 1.0), 1),
                    Role::kConstraint);
    view = std::make_unique<View>(problem);
  }
  Evaluator Begin(const Stop& stop) const {
    Evaluator evaluator;
    evaluator.Prepare(*view);
    evaluator.Begin(*view, stop);
    return evaluator;
  }
  Problem problem;
  std::unique_ptr<View> view;
};

TEST(Evaluator, KeepsTheBestFeasiblePointNotTheCheapest) {
  Bounded b;
  const Stop stop;
  Evaluator evaluator = b.Begin(stop);
  for (const double x : {2.9, 0.0, 0.9, 2.0, 0.5}) ASSERT_TRUE(evaluator.Evaluate(&x, {}));
  EXPECT_EQ(evaluator.best()[0], 0.9);
  EXPECT_NEAR(evaluator.best_cost(), 2.1 * 2.1, 1e-12);
}

TEST(Evaluator, WhileNothingIsFeasibleKeepsTheLeastViolation) {
  Bounded b;
  const Stop stop;
  Evaluator evaluator = b.Begin(stop);
  for (const double x : {2.9, 1.5, 2.0}) ASSERT_TRUE(evaluator.Evaluate(&x, {}));
  EXPECT_EQ(evaluator.best()[0], 1.5);
  EXPECT_NEAR(evaluator.best_violation(), 0.5, 1e-12);
}

TEST(Evaluator, AnEarlierSolveLeavesNoCosts) {
  Bounded b;
  const Stop stop;
  Evaluator evaluator = b.Begin(stop);
  const double x = 0.9;
  ASSERT_TRUE(evaluator.Evaluate(&x, {}));
  EXPECT_GT(evaluator.best_cost_by_term()[0], 0.0);
  evaluator.Begin(*b.view, stop);
  EXPECT_EQ(evaluator.best_cost_by_term()[0], 0.0);
  EXPECT_EQ(evaluator.first_cost(), 0.0);
}

TEST(Evaluator, AnswersARepeatedQuestionFromItsCache) {
  Bounded b;
  const Stop stop;
  Evaluator evaluator = b.Begin(stop);
  const double x = 0.25;
  ASSERT_TRUE(evaluator.Evaluate(&x, {.gradient = true}));
  ASSERT_TRUE(evaluator.Evaluate(&x, {}));
  EXPECT_EQ(evaluator.evaluations(), 1);
  ASSERT_TRUE(evaluator.Evaluate(&x, {.hessian = true}));  // more of the same point
  EXPECT_EQ(evaluator.evaluations(), 1);
  EXPECT_DOUBLE_EQ(evaluator.last().hessian.At(0, 0), 2.0);
  EXPECT_DOUBLE_EQ(evaluator.last().gradient[0], 2.0 * (0.25 - 3.0));
}

TEST(Evaluator, TheLagrangiansHessianDoesNotReplaceTheObjectives) {
  Bounded b;
  const Stop stop;
  Evaluator evaluator = b.Begin(stop);
  const double x = 0.25, multiplier = 3.0;
  const RowWeights rows[] = {{}, {.multiplier = &multiplier}};
  ASSERT_TRUE(evaluator.EvaluateLagrangian(&x, {.objective_factor = 0.5, .rows = rows}));
  EXPECT_DOUBLE_EQ(evaluator.last().hessian.At(0, 0), 1.0);  // half of 2; the row is linear
  EXPECT_DOUBLE_EQ(evaluator.last().gradient[0], 2.0 * (0.25 - 3.0));
  ASSERT_TRUE(evaluator.Evaluate(&x, {.hessian = true}));
  EXPECT_DOUBLE_EQ(evaluator.last().hessian.At(0, 0), 2.0);
  EXPECT_EQ(evaluator.evaluations(), 1);
}

TEST(Evaluator, StopsOnItsBudgets) {
  Bounded b;
  Stop stop;
  stop.max_evaluations = 2;
  Evaluator evaluator = b.Begin(stop);
  double x = 0.0;
  evaluator.Evaluate(&x, {});
  EXPECT_FALSE(evaluator.must_stop());
  x = 0.1;
  evaluator.Evaluate(&x, {});
  EXPECT_TRUE(evaluator.must_stop());
  EXPECT_EQ(evaluator.stop_status(), SolveStatus::kIterationLimit);
}

}  // namespace
}  // namespace touchdown::solvers
