// SPDX-License-Identifier: BSD-3-Clause
// Bounds on variables, in the problem and with every backend that takes them.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solvers/test/every_backend.h"
#include "touchdown/solvers/allocation_count.h"
#include "touchdown/solvers/problems/reference_problem.h"

namespace touchdown::solvers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(VariableBounds, AreRefusedWhereTheyAreNone) {
  Problem problem({.blocks = 2, .block_size = 1});
  EXPECT_THROW(problem.SetBounds({0.0}, {1.0}), std::invalid_argument);
  EXPECT_THROW(problem.SetBounds({0.0, 2.0}, {1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(problem.SetBounds({0.0, std::nan("")}, {1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(problem.SetBounds({kInfinity, 0.0}, {kInfinity, 1.0}), std::invalid_argument);
  EXPECT_FALSE(problem.bounded());
  problem.SetBounds({0.0, -kInfinity}, {1.0, kInfinity});
  EXPECT_TRUE(problem.bounded());
}

TEST(VariableBounds, AreCountedAsViolated) {
  Problem problem({.blocks = 2, .block_size = 1});
  problem.SetBounds({0.0, -kInfinity}, {1.0, 2.0});
  const View view(problem);
  ViewEvaluation at;
  view.Resize(&at);
  for (const auto& [y, violation] : {std::pair(Eigen::Vector2d(0.5, -9.0), 0.0),
                                     {Eigen::Vector2d(-0.25, 0.0), 0.25},
                                     {Eigen::Vector2d(1.5, 2.75), 0.75}}) {
    ASSERT_TRUE(view.Evaluate(y.data(), {}, {}, &at));
    EXPECT_EQ(at.full.max_violation, violation);
  }
}

class BoundsOfEveryBackend : public EveryBackend {
 protected:
  /// The result, or nothing where the backend takes no bounds and says so.
  bool SolveReference(const ReferenceProblem& p, SolverResult* result, const Stop& stop = {}) {
    const View view(*p.problem);
    auto backend = Make();
    if (!backend->capabilities().variable_bounds) {
      EXPECT_EQ(backend->Refusal(view),
                "backend " + GetParam() + " takes no bounds on variables: make them costs");
      return false;
    }
    backend->Prepare(view);
    backend->Solve(view, p.start, stop, result);
    return true;
  }
};

TEST_P(BoundsOfEveryBackend, HoldWhereTheCostPushes) {
  // Three bounds of which the first two are met, and one variable without.
  const ReferenceProblem p = SmallProblem("corner", {0.5, 0.5, 0.5, 0.5}, 5.0, EqualityForm::kRows)
                                 .Squares(4,
                                          [](const auto* x, auto* u) {
                                            u[0] = x[0] - 3.0;
                                            u[1] = x[1] + 2.0;
                                            u[2] = x[2] - 0.25;
                                            u[3] = x[3] - x[2];
                                          })
                                 .Bound(0, 0.0, 2.0)
                                 .Bound(1, 0.0, 2.0)
                                 .Bound(2, 0.0, 2.0);
  SolverResult result;
  if (!SolveReference(p, &result)) return;
  EXPECT_EQ(result.status, SolveStatus::kConverged) << result.message;
  EXPECT_NEAR(result.cost, 5.0, 1e-6);
  EXPECT_LE((result.x - Eigen::Vector4d(2.0, 0.0, 0.25, 0.25)).lpNorm<Eigen::Infinity>(), 1e-3);
  EXPECT_EQ(result.max_violation, 0.0);
  if (result.bound_multipliers.empty()) return;
  const std::vector<double> wanted = {2.0, -4.0, 0.0, 0.0};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(result.bound_multipliers[i], wanted[i], 1e-4) << i;
}

TEST_P(BoundsOfEveryBackend, NothingIsEvaluatedBeyondThem) {
  const ReferenceProblem p = SmallProblem("logarithm", {9.0, -3.0}, 0.0, EqualityForm::kRows)
                                 .Cost([](const auto* x, auto* u) {
                                   using std::log;
                                   u[0] = x[0] - 0.1 * log(x[0]) + x[1] * x[1];
                                 })
                                 .Bound(0, 1e-9, 10.0)
                                 .Bound(1, 1.0, 1.0 + 1e-3);
  SolverResult result;
  Stop stop;
  stop.callback = [](const StopQuery& query) {
    EXPECT_GE(query.y[0], 1e-9);
    EXPECT_LE(query.y[0], 10.0);
    EXPECT_EQ(query.max_violation, 0.0);
    return false;
  };
  if (!SolveReference(p, &result, stop)) return;
  EXPECT_TRUE(result.usable()) << ToString(result.status);
  EXPECT_GE(result.x[1], 1.0) << "where it began was not inside";
}

TEST_P(BoundsOfEveryBackend, AVariableMayBeFixed) {
  const ReferenceProblem p = SmallProblem("fixed", {0.0, 7.0}, 4.0, EqualityForm::kRows)
                                 .Squares(2,
                                          [](const auto* x, auto* u) {
                                            u[0] = x[0] + x[1] - 6.0;
                                            u[1] = x[0] - x[1];
                                          })
                                 .Bound(1, 5.0, 5.0);
  SolverResult result;
  if (!SolveReference(p, &result)) return;
  EXPECT_EQ(result.status, SolveStatus::kConverged) << result.message;
  EXPECT_NEAR(result.x[0], 3.0, 1e-4);
  EXPECT_NEAR(result.x[1], 5.0, 1e-9);
}

TEST_P(BoundsOfEveryBackend, ARowWithoutAFreeVariableIsAConstant) {
  if (!Make()->capabilities().equality_rows) return;
  const auto minus = [](double value) {
    return [value](const auto* x, auto* u) { u[0] = x[0] - value; };
  };
  // x is 2 by its bounds, and a row says the same or another value. y is free, or has as many rows
  // as there are free variables, or is fixed, too.
  for (const double told : {2.0, 3.0}) {
    for (const auto& [rows_of_y, upper] : {std::pair(0, kInfinity), {1, kInfinity}, {0, -1.0}}) {
      Problem problem({.blocks = 2, .block_size = 1});
      const auto add = [&](const FunctionShape& shape, double value, Role role) {
        problem.AddTerm(std::make_shared<FunctionTerm>(
                            TermInfo{.name = "minus"}, shape, SquareLoss(1.0), minus(value)),
                        role);
      };
      add({.windows = 2}, 1.0, Role::kCost);
      add({.windows = 1}, told, Role::kConstraint);
      if (rows_of_y > 0) add({.first = 1, .windows = rows_of_y}, 0.5, Role::kConstraint);
      problem.SetBounds({2.0, -1.0}, {2.0, upper});
      const SolverResult result = Solve(problem, Eigen::Vector2d(0.0, 0.0));
      EXPECT_EQ(result.status,
                told == 2.0 ? SolveStatus::kConverged : SolveStatus::kInfeasible)
          << rows_of_y << " " << upper << ": " << ToString(result.status);
      if (told != 2.0) continue;
      EXPECT_EQ(result.x[0], 2.0);
      EXPECT_NEAR(result.x[1], upper < 0.0 ? upper : rows_of_y > 0 ? 0.5 : 1.0, 1e-4);
    }
  }
}

TEST_P(BoundsOfEveryBackend, AsManyEqualitiesAsFreeVariablesMayLeaveAChoice) {
  if (!Make()->capabilities().equality_rows) return;
  // x + y = 2, twice; then once where z, of the same block, is fixed and has a row of its own.
  for (const bool fixed : {false, true}) {
    const ReferenceProblem p =
        SmallProblem("twice", {0.0, 5.0, 3.0}, 2.0, EqualityForm::kRows)
            .Squares(3,
                     [](const auto* x, auto* u) {
                       u[0] = x[0] - 2.0;
                       u[1] = x[1] - 2.0;
                       u[2] = x[2] - 3.0;
                     })
            .Zero(3,
                  [fixed](const auto* x, auto* u) {
                    u[0] = x[0] + x[1] - 2.0;
                    u[1] = fixed ? x[2] - 3.0 : 2.0 * u[0];
                    u[2] = 0.5 * u[0];
                  })
            .Bound(2, fixed ? 3.0 : -kInfinity, fixed ? 3.0 : kInfinity);
    SolverResult result;
    if (!SolveReference(p, &result)) return;
    EXPECT_NE(result.status, SolveStatus::kInfeasible) << fixed << ": " << result.message;
    if (GetParam() == "nlopt-slsqp") continue;  // dependent rows are beyond its subproblem
    EXPECT_EQ(result.status, SolveStatus::kConverged) << fixed << ": " << result.message;
    EXPECT_NEAR(result.cost, 2.0, 1e-6) << fixed;
  }
}

TEST_P(BoundsOfEveryBackend, AHillIsLeftFromEverywhere) {
  for (const double start : {-0.99, -0.5, -0.01, 0.01, 0.05, 0.1, 0.3, 1.0, 1.9}) {
    const ReferenceProblem p = SmallProblem("hill", {start}, -4.0, EqualityForm::kRows)
                                   .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[0]; })
                                   .Bound(0, -1.0, 2.0);
    SolverResult result;
    if (!SolveReference(p, &result)) return;
    EXPECT_EQ(result.status, SolveStatus::kConverged) << start << " " << ToString(result.status);
    EXPECT_LE(std::min(std::abs(result.cost + 4.0), std::abs(result.cost + 1.0)), 1e-6) << start;
  }
}

TEST_P(BoundsOfEveryBackend, MayHaveOtherValuesInTheNextSolve) {
  Problem problem({.blocks = 1, .block_size = 3});
  problem.AddTerm(
      std::make_shared<FunctionTerm>(TermInfo{.name = "square"},
                                     FunctionShape{.block_size = 3, .outputs = 3}, SquareLoss(2.0),
                                     [](const auto* x, auto* u) {
                                       for (int i = 0; i < 3; ++i) u[i] = x[i];
                                     }),
      Role::kCost);
  const auto backend = Make();
  if (!backend->capabilities().variable_bounds) return;
  for (const double at : {1.0, 2.0, 3.0}) {
    problem.SetBounds({at, at, -kInfinity}, {at, kInfinity, -at});
    const View view(problem);
    if (at == 1.0) backend->Prepare(view);
    SolverResult result;
    backend->Solve(view, WarmStart(Eigen::Vector3d(7.0, 7.0, -7.0)), {.max_iterations = 300},
                   &result);
    EXPECT_TRUE(result.usable()) << at;
    EXPECT_NEAR(result.cost, 3.0 * at * at, 1e-5 * at * at) << at;
  }
  problem.SetBounds({1.0, -kInfinity, -kInfinity}, {1.0, kInfinity, -1.0});
  SolverResult result;
  EXPECT_THROW(
      backend->Solve(View(problem), WarmStart(Eigen::Vector3d(1.0, 1.0, -1.0)), {}, &result),
      std::invalid_argument)
      << "a variable has lost its bound";
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(BoundsOfEveryBackend);
INSTANTIATE_TEST_SUITE_P(Backends, BoundsOfEveryBackend, ::testing::ValuesIn(CompiledBackends()),
                         TestName);

TEST(VariableBounds, NeedTheProblemsOwnVariables) {
  Problem problem({.blocks = 2, .block_size = 1});
  problem.AddTerm(SumOfSquares<1, 1>(
                      "square", [](const auto* x, auto* u) { u[0] = x[0]; }, true),
                  Role::kCost);
  problem.SetBounds({0.0, 0.0}, {1.0, 1.0});
  AffineLift half;
  half.reduced_blocks = 1;
  half.block = {0, 0};
  half.coefficient = {1.0, 1.0};
  const View view(problem, half);
  EXPECT_EQ(MakeBackend(StandardBackends(), "banded")->Refusal(view),
            "bounds on variables need a view of the problem's own variables");
}

TEST(VariableBounds, BandedDoesNotAllocate) {
  if (AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  Problem problem = Scalars(40);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  problem.SetBounds(std::vector<double>(40, -1.5), std::vector<double>(40, 0.8));
  const View view(problem);
  const auto solver = MakeBackend(StandardBackends(), "banded");
  solver->Prepare(view);
  const WarmStart start(Eigen::VectorXd::Constant(40, -1.0));
  SolverResult result;
  solver->Solve(view, start, {}, &result);
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  const long before = AllocationCount();
  solver->Solve(view, start, {}, &result);
  EXPECT_EQ(AllocationCount() - before, 0);
}

TEST(VariableBounds, WhatIsBeyondAnyNumberIsNone) {
  Problem problem({.blocks = 1, .block_size = 2});
  problem.SetBounds({-1e30, -2.0}, {3.0, 1e20});
  EXPECT_TRUE(std::isinf(problem.lower(0)) && std::isinf(problem.upper(1)));
  EXPECT_EQ(problem.lower(1), -2.0);
  const LossBounds bounds = RangeLoss({-1e30, 1.5}, 1.0, 1.0).bounds();
  EXPECT_TRUE(std::isinf(bounds.lo));
  EXPECT_EQ(bounds.hi, 1.5);
  EXPECT_THROW(problem.SetBounds({1e30, 0.0}, {1e20, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::solvers
