// SPDX-License-Identifier: BSD-3-Clause
// What `banded` guarantees beyond the conformance suite. Newton solves a quadratic problem in one
// step. The interior point's multipliers meet the optimality conditions. Rows that cannot be met
// have an elastic answer. A solve does not allocate.

#include "solvers/banded/banded_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <type_traits>

#include "solvers/test/test_terms.h"
#include "touchdown/solvers/allocation_count.h"
#include "touchdown/solvers/problem/window_term.h"
#include "touchdown/solvers/problems/reference_problem.h"
#include "touchdown/solvers/solvers.h"

namespace touchdown::solvers {
namespace {

/// Second differences of a chain of points, pulled towards targets.
class Chain {
 public:
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 6;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;
  Chain(int blocks, std::mt19937_64* random) : blocks_(blocks) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < 3 * blocks; ++i) targets_.push_back(normal(*random));
  }
  int windows() const { return blocks_ - 2; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int k, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    for (int c = 0; c < 3; ++c) {
      u[c] = 3.0 * (q[c] - 2.0 * q[3 + c] + q[6 + c]);
      u[3 + c] = q[3 + c] - targets_[static_cast<std::size_t>(3 * k + c)];
    }
  }

 private:
  int blocks_;
  std::vector<double> targets_;
};

/// |q|^2 <= r^2 for every block: a small model of a landing's norm rows.
class Ball {
 public:
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  Ball(int blocks, double radius) : blocks_(blocks), radius_(radius) {}
  int windows() const { return blocks_; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - radius_ * radius_) * (0.5 / radius_);
  }

 private:
  int blocks_;
  double radius_;
};

/// |q_(k+1) - q_k|^2 <= r^2: a limit of speed.
class Pace {
 public:
  static constexpr int kBlockSize = 3, kWindow = 2, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  Pace(int blocks, double radius) : blocks_(blocks), radius_(radius) {}
  int windows() const { return blocks_ - 1; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = T(-0.5 * radius_);
    for (int c = 0; c < 3; ++c) u[0] += (q[3 + c] - q[c]) * (q[3 + c] - q[c]) * (0.5 / radius_);
  }

 private:
  int blocks_;
  double radius_;
};

/// x >= level for the first coordinate of every block.
class Wall {
 public:
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;
  Wall(int blocks, double level) : blocks_(blocks), level_(level) {}
  int windows() const { return blocks_; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = level_ - q[0];
  }

 private:
  int blocks_;
  double level_;
};

constexpr int kBlocks = 12;

Problem ChainProblem(std::uint64_t seed = 11) {
  std::mt19937_64 random(seed);
  Problem problem({.blocks = kBlocks, .block_size = 3});
  problem.AddTerm(
      std::make_shared<WindowTerm<Chain, SquareLoss>>(
          TermInfo{"chain", "", "", "", true}, Chain(kBlocks, &random), SquareLoss(2.0), kBlocks),
      Role::kCost);
  return problem;
}

template <class Inner>
void AddRows(const Inner& inner, Problem* problem) {
  problem->AddTerm(std::make_shared<WindowTerm<Inner, HingeLoss>>(
                       TermInfo{"rows", "", "", "", true}, inner, HingeLoss(1.0, 0.1), kBlocks),
                   Role::kConstraint);
}

SolverResult Solve(const View& view, double gap = 1e-7, bool confirm = true) {
  auto solver = MakeBandedSolver();
  solver->options().Set("gap_tolerance", gap);
  solver->Prepare(view);
  Stop stop;
  stop.confirm = confirm;
  SolverResult result;
  solver->Solve(view, WarmStart(Eigen::VectorXd::Constant(view.num_variables(), 0.3)), stop,
                &result);
  return result;
}

TEST(BandedSolver, SolvesAQuadraticInOneStep) {
  const Problem problem = ChainProblem();
  const View view(problem);
  const SolverResult result = Solve(view);
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_EQ(result.iterations, 1);
}

// Shorter steps are tried by their value alone; one that has no derivatives must not be taken.
TEST(BandedSolver, StepsOverWhereATermHasNoDerivatives) {
  const auto root = [](const auto* q, auto* u) {
    using std::sqrt;
    using T = std::decay_t<decltype(*u)>;
    u[0] = sqrt(sqrt(T(1.0) + q[0] * q[0]));  // from 2 Newton's step leads to -8, a quarter to -0.5
    if (!std::is_same_v<T, double> && q[0] < T(-0.1) && q[0] > T(-1.0)) u[0] *= std::nan("");
  };
  Problem problem({.blocks = 1, .block_size = 1});
  problem.AddTerm(SumOfSquares<1, 1>("root", root, true), Role::kCost);
  const View view(problem);
  auto solver = MakeBandedSolver();
  solver->Prepare(view);
  SolverResult result;
  Stop stop;
  stop.trace = true;
  solver->Solve(view, WarmStart(Eigen::VectorXd::Constant(1, 2.0)), stop, &result);
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_NEAR(result.x[0], 0.0, 1e-3);
  ASSERT_FALSE(result.trace.empty());
  EXPECT_NEAR(result.trace.front().step_norm, 1.25, 1e-9);  // an eighth of Newton's
}

TEST(BandedSolver, ConvergesWhereTheCostIsZero) {
  // Started at its optimum, or beside it, a problem without residual leaves only rounding.
  Problem problem({.blocks = kBlocks, .block_size = 3});
  problem.AddTerm(
      std::make_shared<WindowTerm<Ball, SquareLoss>>(TermInfo{"sphere", "", "", "", false},
                                                     Ball(kBlocks, 0.5), SquareLoss(1.0), kBlocks),
      Role::kCost);
  const View view(problem);
  for (const double start : {0.5 / std::sqrt(3.0), 0.29, 0.2}) {
    auto solver = MakeBandedSolver();
    solver->Prepare(view);
    SolverResult result;
    solver->Solve(view, WarmStart(Eigen::VectorXd::Constant(view.num_variables(), start)), {},
                  &result);
    EXPECT_EQ(result.status, SolveStatus::kConverged) << start;
    EXPECT_LT(result.cost, 1e-12);
  }
}

TEST(BandedSolver, AConstantInTheCostChangesNothing) {
  for (const double constant : {0.0, 5.0, 1e8}) {
    for (const double factor : {0.0, 1e-12, 1.0}) {
      const ReferenceProblem p =
          SmallProblem("rosenbrock", {-1.2, 1.0}, constant, EqualityForm::kRows)
              .Cost([=](const auto* x, auto* u) {
                const auto a = x[1] - x[0] * x[0], b = 1.0 - x[0];
                u[0] = factor * (100.0 * a * a + b * b) + constant;
              });
      if (constant > 0.0 && factor == 1e-12) continue;  // it is below the constant's last digit
      const SolverResult result = solvers::Solve(*p.problem, p.start);
      EXPECT_EQ(result.status, SolveStatus::kConverged) << constant << " " << factor;
      if (factor > 0.0) {
        EXPECT_NEAR(result.x[0], 1.0, 1e-3) << constant << " " << factor;
      }
    }
  }
}

TEST(BandedSolver, MeetsTheOptimalityConditions) {
  Problem problem = ChainProblem();
  AddRows(Ball(kBlocks, 0.5), &problem);
  const View view(problem);
  const SolverResult result = Solve(view, 1e-12);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT(result.max_violation, 1e-8);

  // grad f + G^T lambda = 0, lambda >= 0, lambda u = 0.
  ViewEvaluation e;
  view.Resize(&e);
  ASSERT_TRUE(view.Evaluate(result.x.data(), {.gradient = true}, {}, &e));
  ASSERT_EQ(result.multipliers.size(), 2u);
  const std::vector<double>& lambda = result.multipliers[1];
  Eigen::VectorXd rows(view.num_variables());
  const double* weights[] = {nullptr, lambda.data()};
  view.MultiplyRowsTransposed(weights, &e, rows.data());
  const Eigen::Map<const Eigen::VectorXd> gradient(e.gradient.data(), view.num_variables());
  EXPECT_LT((gradient + rows).cwiseAbs().maxCoeff(), 1e-6 * gradient.cwiseAbs().maxCoeff());
  int active = 0;
  for (int k = 0; k < kBlocks; ++k) {
    EXPECT_GE(lambda[k], 0.0);
    EXPECT_LT(std::abs(lambda[k] * e.full.terms[1].u[k]), 1e-8);
    active += lambda[k] > 1e-3;
  }
  EXPECT_GT(active, 0);
}

// A merit function that took no step uphill would halve them over and over (N. Maratos 1978).
TEST(BandedSolver, StepsOverCurvedRowsAreLong) {
  int iterations = 0, evaluations = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Problem problem = ChainProblem(seed);
    problem.AddTerm(
        std::make_shared<WindowTerm<Wall, HingeLoss>>(
            TermInfo{"wall", "", "", "", true}, Wall(kBlocks, 0.3), HingeLoss(1e4, 0.02), kBlocks),
        Role::kCost);
    AddRows(Pace(kBlocks, 0.05), &problem);
    const View view(problem);
    const SolverResult result = Solve(view, 1e-6, /*confirm=*/false);  // it is too coarse for that
    EXPECT_TRUE(result.usable()) << seed;
    EXPECT_NEAR(result.cost, Solve(view, 1e-10).cost, 1e-5 * result.cost) << seed;
    iterations += result.iterations;
    evaluations += result.evaluations;
  }
  RecordProperty("iterations", iterations);
  RecordProperty("evaluations", evaluations);
  EXPECT_LT(iterations, 20 * 20);
  EXPECT_LT(evaluations, iterations + 20 * 5);
}

TEST(BandedSolver, SaysInfeasibleAndGivesTheElasticCompromise) {
  Problem problem = ChainProblem();
  AddRows(Ball(kBlocks, 0.5), &problem);
  AddRows(Wall(kBlocks, 0.7), &problem);  // 0.2 beyond the ball
  const View view(problem);
  const SolverResult result = Solve(view);
  EXPECT_EQ(result.status, SolveStatus::kInfeasible);
  EXPECT_TRUE(result.x.allFinite());
  // Neither kind of row is given up for the other.
  EXPECT_GT(result.max_violation, 0.05);
  EXPECT_LT(result.max_violation, 0.3);
}

/// As Ball, on the first `windows` blocks only.
class SomeBalls : public Ball {
 public:
  SomeBalls(int blocks, double radius) : Ball(blocks, radius), windows_(blocks) {}
  int windows() const { return windows_; }
  void set_windows(int windows) { windows_ = windows; }

 private:
  int windows_;
};

TEST(BandedSolver, ForgetsTheRowsOfAnEarlierSolve) {
  Problem problem = ChainProblem();
  const auto balls = std::make_shared<WindowTerm<SomeBalls, HingeLoss>>(
      TermInfo{"rows", "", "", "", true}, SomeBalls(kBlocks, 0.3), HingeLoss(1.0, 0.1), kBlocks);
  problem.AddTerm(balls, Role::kConstraint);
  const View view(problem);
  const WarmStart warm(Eigen::VectorXd::Constant(view.num_variables(), 0.3));
  auto used = MakeBandedSolver();
  used->Prepare(view);
  SolverResult result;
  used->Solve(view, warm, {}, &result);
  balls->inner().set_windows(3);
  used->Solve(view, warm, {}, &result);
  auto fresh = MakeBandedSolver();
  fresh->Prepare(view);
  SolverResult expected;
  fresh->Solve(view, warm, {}, &expected);
  EXPECT_EQ(result.x, expected.x);
  EXPECT_EQ(result.iterations, expected.iterations);
}

TEST(BandedSolver, ARefusedPrepareLeavesTheEarlierOne) {
  const Problem problem = ChainProblem();
  const View view(problem);
  Problem bounded({.blocks = 2, .block_size = 1});
  bounded.SetBounds({0.0, 0.0}, {1.0, 1.0});
  AffineLift one;  // both blocks are the same
  one.reduced_blocks = 1;
  one.block = {0, 0};
  one.coefficient = {1.0, 1.0};
  const View refused(bounded, one);
  auto solver = MakeBandedSolver();
  solver->Prepare(view);
  EXPECT_THROW(solver->Prepare(refused), std::invalid_argument);
  SolverResult result;
  solver->Solve(view, WarmStart(Eigen::VectorXd::Zero(view.num_variables())), {}, &result);
  EXPECT_EQ(result.status, SolveStatus::kConverged);
}

TEST(BandedSolver, DoesNotAllocateInASolve) {
  if (AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  for (const bool hard : {false, true}) {
    Problem problem = ChainProblem();
    if (hard) AddRows(Ball(kBlocks, 0.5), &problem);
    const View view(problem);
    auto solver = MakeBandedSolver();
    solver->Prepare(view);
    const WarmStart warm(Eigen::VectorXd::Constant(view.num_variables(), 0.3));
    SolverResult result;
    SolverBackend::Reserve(view, &result);
    const long before = AllocationCount();
    solver->Solve(view, warm, {}, &result);
    EXPECT_EQ(AllocationCount() - before, 0) << (hard ? "hard" : "soft");
    EXPECT_EQ(result.status, SolveStatus::kConverged);
  }
}

TEST(BandedSolver, AFarStepWhereHardlyAnythingCurvesIsShortened) {
  // Beyond a hair's width of its kink the cost is a line.
  Problem kink({.blocks = 1, .block_size = 2});
  kink.AddTerm(std::make_shared<FunctionTerm>(TermInfo{.name = "kink"},
                                              FunctionShape{.block_size = 2}, LinearLoss(1.0),
                                              [](const auto* x, auto* u) {
                                                using std::sqrt;
                                                u[0] = sqrt(x[0] * x[0] + 1e-12) + x[1] * x[1];
                                              }),
               Role::kCost);
  const View view(kink);
  const auto solver = MakeBackend(StandardBackends(), "banded");
  solver->Prepare(view);
  SolverResult result;
  solver->Solve(view, WarmStart(Eigen::Vector2d(1.0, 0.5)), {}, &result);
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_NEAR(result.cost, 1e-6, 1e-9);
}

TEST(BandedSolver, ACostThatFallsWithoutEndIsUnbounded) {
  const auto status = [](auto cost) {
    Problem problem({.blocks = 1, .block_size = 2});
    problem.AddTerm(
        std::make_shared<FunctionTerm>(TermInfo{.name = "cost"}, FunctionShape{.block_size = 2},
                                       LinearLoss(1.0), cost),
        Role::kCost);
    return Solve(problem, Eigen::Vector2d(1.0, 1.0)).status;
  };
  EXPECT_EQ(status([](const auto* x, auto* u) { u[0] = x[0] + 2.0 * x[1]; }),
            SolveStatus::kUnbounded);
  EXPECT_EQ(status([](const auto* x, auto* u) { u[0] = x[0] + x[1] * x[1]; }),
            SolveStatus::kUnbounded);
}

}  // namespace
}  // namespace touchdown::solvers
