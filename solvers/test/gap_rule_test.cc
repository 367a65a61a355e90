// SPDX-License-Identifier: BSD-3-Clause
// One stop rule for all backends: each ends as near to the optimum as requested, and not much nearer.

#include "touchdown/solvers/backend/gap_rule.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "solvers/test/every_backend.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::solvers {
namespace {

constexpr int kN = 6;
constexpr double kGaps[] = {0.1, 1e-2, 1e-3};

/// Convex, badly scaled, with a hinge that acts on some of the scalars; as rows these are hard.
Problem Chain(std::uint64_t seed, Role role_of_hinges) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> draw(0.0, 1.0);
  std::array<double, kN> weight, wanted, highest;
  for (int i = 0; i < kN; ++i) {
    weight[i] = std::pow(10.0, 1.5 * draw(random));
    wanted[i] = 4.0 * draw(random) - 1.0;
    highest[i] = 2.0 * draw(random);
  }
  Problem problem = Scalars(kN);
  problem.AddTerm(Whole<kN, 2 * kN - 1>("chain", SquareLoss(2.0),
                                        [=](const auto* x, auto* u) {
                                          for (int i = 0; i < kN; ++i) {
                                            u[i] = weight[i] * (x[i] - wanted[i]);
                                          }
                                          for (int i = 1; i < kN; ++i) {
                                            u[kN + i - 1] = 8.0 * (x[i] - x[i - 1]);
                                          }
                                        }),
                  Role::kCost);
  problem.AddTerm(Whole<kN, kN>("hinges", HingeLoss(1.0, 100.0),
                                [=](const auto* x, auto* u) {
                                  for (int i = 0; i < kN; ++i) u[i] = x[i] - highest[i];
                                }),
                  role_of_hinges);
  return problem;
}

Eigen::VectorXd FarStart() { return Eigen::VectorXd::Constant(kN, -1.0); }

double Optimum(const Problem& problem) {
  const View view(problem);
  auto backend = MakeBackend(StandardBackends(), "banded");
  backend->options().Set("gap_tolerance", 1e-13);
  backend->Prepare(view);
  SolverResult result;
  backend->Solve(view, FarStart(), {}, &result);
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  return result.cost;
}

class GapOfEveryBackend : public EveryBackend {
 protected:
  /// Ends within each gap of the optimum, the earlier the wider it is.
  void ExpectEndsWithin(Role role) {
    int earlier = 0, solves = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Problem problem = Chain(seed, role);
      const double least = Optimum(problem);
      const Eigen::VectorXd start = FarStart();
      Stop stop;
      stop.max_iterations = 3000;
      int before = 0;
      for (const double gap : kGaps) {
        stop.gap = gap;
        const SolverResult near = Solve(problem, start, stop);
        EXPECT_EQ(near.status, SolveStatus::kConverged) << seed << " " << near.message;
        EXPECT_LE(near.cost - least, gap * near.cost) << "seed " << seed << ", gap " << gap;
        EXPECT_LE(near.max_violation, Evaluator::kFeasible);
        EXPECT_GE(near.evaluations, before) << "seed " << seed << ", gap " << gap;
        before = near.evaluations;
        stop.gap = 0.0;
        const int without = Solve(problem, start, stop).evaluations;
        EXPECT_LE(near.evaluations, without);
        earlier += near.evaluations < without;
        ++solves;
      }
    }
    EXPECT_GT(earlier, solves / 2) << "of " << solves << " end before the backend ends them";
  }
};

TEST_P(GapOfEveryBackend, EndsWithinTheGapOfTheOptimum) { ExpectEndsWithin(Role::kCost); }

class GapOfEveryRowBackend : public GapOfEveryBackend {};

TEST_P(GapOfEveryRowBackend, KeepsRowsAndEndsWithinTheGap) { ExpectEndsWithin(Role::kConstraint); }

TEST_P(GapOfEveryBackend, AStartThatIsNearEnoughIsTheAnswer) {
  const Problem problem = Chain(3, Role::kCost);
  const SolverResult first = Solve(problem, FarStart());
  Stop stop;
  stop.gap = 1e-2;
  const SolverResult again = Solve(problem, first.x, stop);
  EXPECT_EQ(again.status, SolveStatus::kConverged);
  EXPECT_EQ(again.iterations, 0);
  EXPECT_EQ(again.evaluations, 1);
  EXPECT_EQ(again.x, first.x);
}

// The start is evaluated before the backend is asked: what a budget allows is the same.
TEST_P(GapOfEveryBackend, ABudgetOfOneEvaluationIsKept) {
  const Problem problem = Chain(4, Role::kCost);
  const View view(problem);
  auto backend = Make();
  backend->Prepare(view);
  Stop stop;
  stop.gap = 1e-3;
  SolverResult result;
  backend->Solve(view, FarStart(), stop, &result);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  stop.max_evaluations = 1;
  backend->Solve(view, FarStart(), stop, &result);
  EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
  EXPECT_EQ(result.evaluations, 1);
  stop.callback = [](const StopQuery&) { return true; };
  stop.max_evaluations = 100;
  backend->Solve(view, FarStart(), stop, &result);
  EXPECT_EQ(result.status, SolveStatus::kStopped);
}

TEST_P(GapOfEveryBackend, WhatTheGapDidNotEndIsStillJudged) {
  Problem problem = Scalars(2);  // a saddle at 0
  problem.AddTerm(Whole<2, 1>("saddle", LinearLoss(1.0),
                              [](const auto* x, auto* u) {
                                u[0] = x[0] * x[0] - x[1] * x[1] + x[1] * x[1] * x[1] * x[1];
                              }),
                  Role::kCost);
  if (Make()->capabilities().needs_residuals) {
    EXPECT_NE(Make()->Refusal(View(problem)), "");
    return;
  }
  Stop stop;
  stop.gap = 1e-2;
  const SolverResult result = Solve(problem, Eigen::VectorXd::Zero(2), stop);
  EXPECT_NE(result.status, SolveStatus::kConverged);
}

TEST_P(GapOfEveryBackend, AGapThatIsNoneIsRefused) {
  const Problem problem = Chain(1, Role::kCost);
  Stop stop;
  for (const double gap : {-0.1, 1.0, std::nan("")}) {
    stop.gap = gap;
    EXPECT_THROW(Solve(problem, Eigen::VectorXd::Zero(kN), stop), std::invalid_argument) << gap;
  }
}

INSTANTIATE_TEST_SUITE_P(Gap, GapOfEveryBackend, ::testing::ValuesIn(CompiledBackends()), TestName);
INSTANTIATE_TEST_SUITE_P(Gap, GapOfEveryRowBackend, ::testing::ValuesIn(CompiledBackends(true)),
                         TestName);

// `banded` keeps the gap with a factor of its own: by the same bound.
TEST(GapRule, BoundsWhereBandedEnds) {
  for (const Role role : {Role::kCost, Role::kConstraint}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Problem problem = Chain(seed, role);
      const double least = Optimum(problem);
      const View view(problem);
      auto backend = MakeBackend(StandardBackends(), "banded");
      backend->Prepare(view);
      OptimalityCheck check;
      check.Prepare(view);
      ViewEvaluation storage;
      view.Resize(&storage);
      Stop stop;
      for (const double gap : kGaps) {
        stop.gap = gap;
        SolverResult result;
        backend->Solve(view, FarStart(), stop, &result);
        const double above = check.Above(view, result.x, &storage);
        EXPECT_GE(above, 0.99 * (result.cost - least) - 1e-9 * least) << "no bound, seed " << seed;
        const double slack = role == Role::kCost ? 1.0 + 1e-6 : 1.5;  // other multipliers
        EXPECT_LE(above, slack * gap * result.cost) << "seed " << seed << ", gap " << gap;
      }
    }
  }
}

// A row may push at a point but not at the optimum: holding it would hide the gain of leaving it.
TEST(GapRule, ARowThatIsLeftIsNotHeld) {
  for (const double b : {0.9, 0.99}) {
    Problem problem = Scalars(2);
    problem.AddTerm(Whole<2, 1>("bowl", LinearLoss(1.0),
                                [=](const auto* x, auto* u) {
                                  u[0] = 0.5 * (x[0] * x[0] + x[1] * x[1]) + b * x[0] * x[1] -
                                         0.01 * x[0] - x[1] + 1000.0;
                                }),
                    Role::kCost);
    problem.AddTerm(AtMostZero<2, 1>("row", [](const auto* x, auto* u) { u[0] = x[0]; }),
                    Role::kConstraint);
    const View view(problem);
    OptimalityCheck check;
    check.Prepare(view);
    ViewEvaluation storage;
    view.Resize(&storage);
    auto backend = MakeBackend(StandardBackends(), "banded");
    backend->Prepare(view);
    SolverResult optimum;
    backend->Solve(view, Eigen::VectorXd(Eigen::VectorXd::Constant(2, -1.0)), {}, &optimum);
    const double gap = 1000.0 - optimum.cost;
    EXPECT_GT(gap, 2.0);
    EXPECT_GE(check.Above(view, Eigen::Vector2d(0.0, 0.0), &storage), 0.999 * gap) << b;
  }
}

struct RuleOf {
  explicit RuleOf(const View& view) {
    check.Prepare(view);
    rule.Prepare(view, &check);
  }
  OptimalityCheck check;
  GapRule rule;
};

TEST(GapRule, ALookDoesNotAllocate) {
  for (const Role role : {Role::kCost, Role::kConstraint}) {
    const Problem problem = Chain(2, role);
    const View view(problem);
    RuleOf rule_of(view);
    GapRule& rule = rule_of.rule;
    rule.Begin(view, 1e-3);
    const Eigen::VectorXd start = FarStart();
    rule.Met(start, 1e6, 0.0);
    const long before = AllocationCount();
    rule.Begin(view, 1e-3);
    rule.Met(start, 1e6, 0.0);
    EXPECT_EQ(AllocationCount(), before);
  }
}

// Half of the excess that a check finds must be gone before the next check.
TEST(GapRule, LooksOnlyWhereTheCostHasFallen) {
  const Problem problem = Chain(2, Role::kCost);
  const View view(problem);
  RuleOf rule_of(view);
  GapRule& rule = rule_of.rule;
  rule.Begin(view, 1e-3);
  const Eigen::VectorXd optimum = [&] {
    auto backend = MakeBackend(StandardBackends(), "banded");
    backend->Prepare(view);
    SolverResult result;
    backend->Solve(view, FarStart(), {}, &result);
    return result.x;
  }();
  const double least = Optimum(problem);
  EXPECT_FALSE(rule.Met(FarStart(), 10.0 * least, 0.0));
  EXPECT_FALSE(rule.Met(FarStart(), 10.0 * least, 0.0)) << "twice as many points";
  EXPECT_FALSE(rule.Met(optimum, 10.0 * least, 0.0)) << "no cheaper than the last look";
  EXPECT_FALSE(rule.Met(optimum, least, 1e-3)) << "beyond a row";
  rule.Begin(view, 1e-3);
  EXPECT_TRUE(rule.Met(optimum, least, 0.0));
}

}  // namespace
}  // namespace touchdown::solvers
