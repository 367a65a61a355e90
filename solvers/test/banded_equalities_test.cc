// SPDX-License-Identifier: BSD-3-Clause
// Equality rows in `banded`: consistent ones are met from everywhere, redundant ones are allowed,
// and multiple shooting is solved.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "solvers/banded/banded_solver.h"
#include "touchdown/solvers/allocation_count.h"
#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/problem/function_term.h"
#include "touchdown/solvers/solve.h"

namespace touchdown::solvers {
namespace {

/// One block of n scalars, with a cost and rows u = 0.
template <class Cost, class Rows>
Problem WithEqualities(int n, Cost cost, int outputs, Rows rows) {
  Problem problem({.blocks = 1, .block_size = n});
  problem.AddTerm(
      std::make_shared<FunctionTerm>(TermInfo{.name = "cost"}, FunctionShape{.block_size = n},
                                     LinearLoss(1.0), cost),
      Role::kCost);
  problem.AddTerm(std::make_shared<FunctionTerm>(TermInfo{.name = "rows"},
                                                 FunctionShape{.block_size = n, .outputs = outputs},
                                                 SquareLoss(1.0), rows),
                  Role::kConstraint);
  return problem;
}

SolverResult SolveFrom(const Problem& problem, const Eigen::VectorXd& start,
                       const std::string& backend = "banded") {
  const View view(problem);
  const auto solver = MakeBackend(StandardBackends(), backend);
  solver->Prepare(view);
  SolverResult result;
  solver->Solve(view, WarmStart(start), {}, &result);
  return result;
}

TEST(BandedEqualities, CurvatureCountsAlongTheRowsAlone) {
  const auto saddle = [](const auto* x, auto* u) { u[0] = x[0] * x[0] - x[1] * x[1]; };
  const auto axis = [](const auto* x, auto* u) { u[0] = x[1] - 0.5 * x[0] - 1.0; };
  const SolverResult result =
      SolveFrom(WithEqualities(2, saddle, 1, axis), Eigen::Vector2d(3.0, -2.0));
  EXPECT_EQ(result.status, SolveStatus::kConverged) << result.message;
  EXPECT_NEAR(result.x[0], 2.0 / 3.0, 1e-7);  // x^2 - (x / 2 + 1)^2
  EXPECT_NEAR(result.multipliers[1][0], 8.0 / 3.0, 1e-6) << "2 y";
}

TEST(BandedEqualities, ALinearCostOnACircle) {
  const auto sum = [](const auto* x, auto* u) { u[0] = x[0] + x[1]; };
  const auto circle = [](const auto* x, auto* u) { u[0] = x[0] * x[0] + x[1] * x[1] - 2.0; };
  for (const Eigen::Vector2d& start : {Eigen::Vector2d(3.0, 0.5), Eigen::Vector2d(-0.1, -2.0)}) {
    const SolverResult result = SolveFrom(WithEqualities(2, sum, 1, circle), start);
    EXPECT_EQ(result.status, SolveStatus::kConverged);
    EXPECT_NEAR(result.cost, -2.0, 1e-7);
  }
}

TEST(BandedEqualities, RedundantRowsAreRows) {
  const auto square = [](const auto* x, auto* u) { u[0] = x[0] * x[0] + 3.0 * x[1] * x[1]; };
  const auto thrice = [](const auto* x, auto* u) {
    for (int i = 0; i < 3; ++i) u[i] = (1.0 + i) * (x[0] + x[1] - 1.0);
  };
  const SolverResult result =
      SolveFrom(WithEqualities(2, square, 3, thrice), Eigen::Vector2d(5.0, 5.0));
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_NEAR(result.x[0], 0.75, 1e-7);
  const std::vector<double>& multipliers = result.multipliers[1];
  EXPECT_NEAR(multipliers[0] + 2.0 * multipliers[1] + 3.0 * multipliers[2], -1.5, 1e-6);
}

/// As WithEqualities, with u >= 0 and `other` <= 0 as two terms.
template <class Cost, class Rows, class Others>
Problem WithPairs(Cost cost, Rows rows, Others others) {
  Problem problem({.blocks = 1, .block_size = 2});
  const auto add = [&](const char* name, FunctionTerm::Loss loss, Role role, auto function) {
    problem.AddTerm(std::make_shared<FunctionTerm>(TermInfo{.name = name},
                                                   FunctionShape{.block_size = 2}, loss, function),
                    role);
  };
  const double infinity = std::numeric_limits<double>::infinity();
  add("cost", LinearLoss(1.0), Role::kCost, cost);
  add("at_least", RangeLoss({0.0, infinity}, 1.0, 1.0), Role::kConstraint, rows);
  add("at_most", RangeLoss({-infinity, 0.0}, 1.0, 1.0), Role::kConstraint, others);
  return problem;
}

TEST(BandedEqualities, ARowAndItsOppositeAreOne) {
  const auto line = [](const auto* x, auto* u) { u[0] = x[0] + x[1] - 1.0; };
  for (const double sign : {1.0, -1.0}) {
    const auto cost = [sign](const auto* x, auto* u) {
      u[0] = (x[0] - 3.0 * sign) * (x[0] - 3.0 * sign) + (x[1] - 3.0 * sign) * (x[1] - 3.0 * sign);
    };
    const SolverResult result = SolveFrom(WithPairs(cost, line, line), Eigen::Vector2d(4.0, -7.0));
    EXPECT_EQ(result.status, SolveStatus::kConverged);
    EXPECT_LE(result.iterations, 3) << "a quadratic cost and a linear row";
    EXPECT_NEAR(result.x[0], 0.5, 1e-7);
    // 2 (0.5 -+ 3) + multiplier = 0, negative at a lower bound.
    EXPECT_NEAR(result.multipliers[1][0], sign > 0.0 ? 0.0 : -7.0, 1e-6);
    EXPECT_NEAR(result.multipliers[2][0], sign > 0.0 ? 5.0 : 0.0, 1e-6);
  }
}

TEST(BandedEqualities, MultipliersOfOneOfTwoOppositesAreNone) {
  const auto line = [](const auto* x, auto* u) { u[0] = x[0] + x[1] - 1.0; };
  const auto cost = [](const auto* x, auto* u) { u[0] = x[0] * x[0] + x[1] * x[1]; };
  const Problem problem = WithPairs(cost, line, line);
  const View view(problem);
  const auto solver = MakeBandedSolver();
  solver->Prepare(view);
  for (const auto& multipliers : std::vector<std::vector<std::vector<double>>>{
           {{}, {-1.0}, {0.0}}, {{}, {0.0}, {1.0}}, {{}, {-1.0}, {1.0}}}) {
    SolverResult result;
    solver->Solve(view, WarmStart(Eigen::Vector2d(4.0, -7.0), multipliers), {}, &result);
    EXPECT_EQ(result.status, SolveStatus::kConverged);
    EXPECT_NEAR(result.cost, 0.5, 1e-6);
  }
}

TEST(BandedEqualities, RowsThatAreAlikeAtTheStartAloneAreNotClaimed) {
  const auto cost = [](const auto* x, auto* u) { u[0] = x[0] * x[0] + x[1] * x[1]; };
  const auto line = [](const auto* x, auto* u) { u[0] = x[0] + x[1] - 1.0; };
  const auto bent = [](const auto* x, auto* u) { u[0] = x[0] + x[1] - 1.0 + x[0] * x[0]; };
  const SolverResult result =
      SolveFrom(WithPairs(cost, line, bent), Eigen::Vector2d(0.0, 3.0));  // only (0, 1) has both
  if (result.status == SolveStatus::kConverged) {
    EXPECT_NEAR(result.cost, 1.0, 1e-6);
  }
}

TEST(BandedEqualities, RowsThatContradictEachOtherAreInfeasible) {
  const auto square = [](const auto* x, auto* u) { u[0] = x[0] * x[0] + x[1] * x[1]; };
  const auto apart = [](const auto* x, auto* u) {
    u[0] = x[0] + x[1] - 1.0;
    u[1] = x[0] + x[1] - 2.0;
  };
  const SolverResult result =
      SolveFrom(WithEqualities(2, square, 2, apart), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(result.status, SolveStatus::kInfeasible);
  EXPECT_FALSE(result.usable());
}

TEST(BandedEqualities, ACircleIsMetFromEverywhere) {
  const auto sum = [](double slope) {
    return [slope](const auto* x, auto* u) { u[0] = slope * (x[0] + x[1]); };
  };
  for (const double slope : {0.01, 1.0, 100.0}) {
    for (const double radius : {0.1, 1.0, 1000.0}) {
      const auto circle = [radius](const auto* x, auto* u) {
        u[0] = x[0] * x[0] + x[1] * x[1] - radius * radius;
      };
      const double best = -std::sqrt(2.0) * slope * radius;
      const std::vector<std::pair<double, double>> starts = {{0.6, 0.8}, {0.06, 0.08}, {1e-4, 1e-4},
                                                             {3.0, 0.5}, {-0.1, -2.0}, {0.01, 0.0},
                                                             {1.0, 1.0}, {-1.0, 1.01}, {7.0, -5.0}};
      for (const auto& [x, y] : starts) {
        const SolverResult result = SolveFrom(WithEqualities(2, sum(slope), 1, circle),
                                              Eigen::Vector2d(x * radius, y * radius));
        // From the diagonal every step stays on it: the maximum is all that can be found, and is
        // none.
        const bool diagonal = x == y;
        const SolveStatus status = result.status;
        EXPECT_NE(status, SolveStatus::kInfeasible) << slope << " " << radius << " " << x;
        EXPECT_TRUE(diagonal || status == SolveStatus::kConverged)
            << slope << " " << radius << " " << x << ": " << ToString(status);
        if (status != SolveStatus::kConverged) continue;
        EXPECT_NEAR(result.cost, best, 1e-6 * (1.0 - best)) << slope << " " << radius << " " << x;
      }
    }
  }
}

TEST(BandedEqualities, AStiffVariableHidesNothing) {
  const auto sum = [](const auto* x, auto* u) { u[0] = x[1] + x[2] - 1.0; };
  for (const double stiff : {1.0, 1e6, 1e11}) {
    const auto cost = [stiff](const auto* x, auto* u) {
      u[0] = stiff * x[0] * x[0] + x[1] * x[1] + 2.0 * x[2] * x[2];
    };
    for (const double off : {0.0, 0.01, 5.0}) {
      const Problem problem = WithEqualities(3, cost, 1, sum);
      const View view(problem);
      const auto solver = MakeBackend(StandardBackends(), "banded");
      solver->Prepare(view);
      Stop stop;
      stop.confirm = false;  // by itself
      SolverResult result;
      solver->Solve(view, WarmStart(Eigen::Vector3d(0.0, 2.0 / 3.0 + off, 1.0 / 3.0 - off)), stop,
                    &result);
      EXPECT_EQ(result.status, SolveStatus::kConverged) << stiff << " " << off;
      EXPECT_NEAR(result.cost, 2.0 / 3.0, 1e-6) << stiff << " " << off;
      EXPECT_NEAR(result.multipliers[1][0], -4.0 / 3.0, 1e-4) << stiff << " " << off;
    }
  }
}

TEST(BandedEqualities, WhatWasGainedDoesNotHideWhatIsLeft) {
  const auto quartic = [](const auto* x, auto* u) {
    const auto a = (x[0] - 1.0) * (x[0] - 1.0);
    u[0] = a * a + x[1] * x[1];
  };
  const auto axis = [](const auto* x, auto* u) { u[0] = x[1]; };
  for (const double far : {1001.0, 10001.0}) {
    const SolverResult result =
        SolveFrom(WithEqualities(2, quartic, 1, axis), Eigen::Vector2d(far, 0.0));
    EXPECT_EQ(result.status, SolveStatus::kConverged);
    EXPECT_LT(result.cost, 1e-6);
  }
}

TEST(BandedEqualities, ForgetAnEarlierProblem) {
  const auto nothing = [](const auto* x, auto* u) { u[0] = 0.0 * x[0]; };
  const auto line = [](const auto* x, auto* u) { u[0] = x[0] - 1.0; };
  const Problem flat = WithEqualities(2, nothing, 1, line);
  Problem product({.blocks = 1, .block_size = 2});
  product.AddTerm(std::make_shared<FunctionTerm>(
                      TermInfo{.name = "cost"}, FunctionShape{.block_size = 2}, LinearLoss(1.0),
                      [](const auto* x, auto* u) { u[0] = 100.0 * x[0] * x[1]; }),
                  Role::kCost);
  product.SetBounds({-1.0, -1.0}, {1.0, 1.0});
  const auto solver = MakeBackend(StandardBackends(), "banded");
  for (const Problem* problem : {&flat, static_cast<const Problem*>(&product)}) {
    const View view(*problem);
    solver->Prepare(view);
    SolverResult result;
    solver->Solve(view, WarmStart(Eigen::Vector2d(0.5, 0.4)), {}, &result);
    EXPECT_EQ(result.status, SolveStatus::kConverged);
    if (problem == &product) {
      EXPECT_NEAR(result.cost, -100.0, 1e-6);
    }
  }
}

/// A pendulum that swings up: blocks of angle, rate and torque, its dynamics rows between
/// neighbours.
Problem SwingUp(int blocks, double most_torque) {
  const double dt = 5.0 / (blocks - 1);
  Problem problem({.blocks = blocks, .block_size = 3});
  const auto add = [&](const char* name, FunctionShape shape, FunctionTerm::Loss loss, Role role,
                       auto function) {
    shape.block_size = 3;
    problem.AddTerm(std::make_shared<FunctionTerm>(TermInfo{.name = name}, shape, loss, function),
                    role);
  };
  add("effort", {.windows = blocks}, SquareLoss(2.0 * dt), Role::kCost,
      [](const auto* x, auto* u) { u[0] = x[2]; });
  add("dynamics", {.window = 2, .outputs = 2, .windows = blocks - 1}, SquareLoss(1.0),
      Role::kConstraint, [dt](const auto* x, auto* u) {
        using std::sin;
        u[0] = x[3] - x[0] - 0.5 * dt * (x[1] + x[4]);
        u[1] = x[4] - x[1] - 0.5 * dt * (x[2] - 4.9 * sin(x[0]) + x[5] - 4.9 * sin(x[3]));
      });
  add("hangs", {.outputs = 2}, SquareLoss(1.0), Role::kConstraint, [](const auto* x, auto* u) {
    u[0] = x[0];
    u[1] = x[1];
  });
  add("stands", {.outputs = 2, .first = blocks - 1}, SquareLoss(1.0), Role::kConstraint,
      [](const auto* x, auto* u) {
        u[0] = x[0] - 3.14159265358979;
        u[1] = x[1];
      });
  add("torque", {.windows = blocks}, RangeLoss({-most_torque, most_torque}, 1.0, 1.0),
      Role::kConstraint, [](const auto* x, auto* u) { u[0] = x[2]; });
  return problem;
}

Eigen::VectorXd StraightUp(int blocks) {
  Eigen::VectorXd start = Eigen::VectorXd::Zero(3 * blocks);
  for (int k = 0; k < blocks; ++k) {
    start[3 * k] = 3.14159265358979 * k / (blocks - 1);
    start[3 * k + 1] = 0.6;
  }
  return start;
}

TEST(BandedEqualities, AMultipleShootingProblemIsAtHome) {
  for (const int blocks : {20, 60}) {
    for (const double most_torque : {50.0, 3.0}) {
      const Problem problem = SwingUp(blocks, most_torque);
      const SolverResult result = SolveFrom(problem, StraightUp(blocks));
      EXPECT_EQ(result.status, SolveStatus::kConverged) << blocks << " " << result.iterations;
      EXPECT_LE(result.max_violation, 1e-8);
      if (!MakeBackend(StandardBackends(), "ipopt")->capabilities().compiled) continue;
      const SolverResult reference = SolveFrom(problem, StraightUp(blocks), "ipopt");
      EXPECT_NEAR(result.cost, reference.cost, 1e-8 * reference.cost);
    }
  }
}

TEST(BandedEqualities, ASolveDoesNotAllocate) {
  if (AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  const Problem problem = SwingUp(20, 50.0);
  const View view(problem);
  const auto solver = MakeBandedSolver();
  solver->Prepare(view);
  const WarmStart start(StraightUp(20));
  SolverResult result;
  Stop stop;
  stop.confirm = false;
  SolverBackend::Reserve(view, &result);
  const long before = AllocationCount();
  solver->Solve(view, start, stop, &result);
  EXPECT_EQ(AllocationCount() - before, 0);
}

TEST(BandedEqualities, ASwingThatTheTorqueDoesNotAllowIsInfeasible) {
  const Problem weak = SwingUp(40, 1.5);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(120);
  for (int k = 0; k < 40; ++k) start[3 * k] = 3.14159265358979 * k / 39.0;
  const SolverResult result = SolveFrom(weak, start);
  EXPECT_EQ(result.status, SolveStatus::kInfeasible);
  EXPECT_NE(result.message, "");
}

TEST(BandedEqualities, AUnicycleThatStandsGoesRoundAPillar) {
  // Blocks of x, y, heading, speed, turn rate; the start stands still throughout.
  constexpr int kSteps = 31, kSize = 5;
  constexpr double kStep = 0.2;
  const double at[] = {0.286, 0.349, 0.345};
  Problem problem({.blocks = kSteps, .block_size = kSize});
  const auto add = [&](const char* name, FunctionShape shape, FunctionTerm::Loss loss, Role role,
                       auto function) {
    shape.block_size = kSize;
    problem.AddTerm(std::make_shared<FunctionTerm>(TermInfo{.name = name}, shape, loss, function),
                    role);
  };
  add("dynamics", {.window = 2, .outputs = 3, .windows = kSteps - 1}, SquareLoss(1.0),
      Role::kConstraint, [=](const auto* q, auto* u) {
        using std::cos, std::sin;
        const auto* next = q + kSize;
        u[0] = next[0] - q[0] - kStep * q[3] * cos(q[2]);
        u[1] = next[1] - q[1] - kStep * q[3] * sin(q[2]);
        u[2] = next[2] - q[2] - kStep * q[4];
      });
  add("stage", {.outputs = 4, .windows = kSteps}, SquareLoss(2.0), Role::kCost,
      [](const auto* q, auto* u) {
        u[0] = 0.3 * (q[0] - 4.0);
        u[1] = 0.3 * q[1];
        u[2] = 0.2 * q[3];
        u[3] = 0.4 * q[4];
      });
  add("end", {.outputs = 3, .first = kSteps - 1}, SquareLoss(2.0), Role::kCost,
      [](const auto* q, auto* u) {
        u[0] = 3.0 * (q[0] - 4.0);
        u[1] = 3.0 * q[1];
        u[2] = q[2];
      });
  add("pillar", {.first = 1, .windows = kSteps - 1}, RangeLoss({0.36, INFINITY}, 1.0, 1.0),
      Role::kConstraint, [](const auto* q, auto* u) {
        u[0] = (q[0] - 2.0) * (q[0] - 2.0) + (q[1] - 0.116) * (q[1] - 0.116);
      });
  std::vector<double> lower(kSteps * kSize, -INFINITY), upper(kSteps * kSize, INFINITY);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(kSteps * kSize);
  for (int k = 0; k < kSteps; ++k) {
    lower[kSize * k + 3] = -0.2, upper[kSize * k + 3] = 1.0;
    lower[kSize * k + 4] = -1.0, upper[kSize * k + 4] = 1.0;
    for (int i = 0; i < 3; ++i) start[kSize * k + i] = at[i];
  }
  for (int i = 0; i < 3; ++i) lower[i] = upper[i] = at[i];
  problem.SetBounds(lower, upper);
  const SolverResult result = Solve(problem, start, "banded", {.max_iterations = 500});
  EXPECT_EQ(result.status, SolveStatus::kConverged) << result.message;
}

}  // namespace
}  // namespace touchdown::solvers
