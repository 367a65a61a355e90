// SPDX-License-Identifier: BSD-3-Clause
// The same problems without rows on every backend, and the same answers to misuse, NaN, exhausted
// budgets and two threads. Rows: constraint_conformance_test.cc.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <thread>

#include "solvers/backend/missing_backend.h"
#include "solvers/test/every_backend.h"

namespace touchdown::solvers {
namespace {

/// (log x + 30)^2: defined only for x > 0, its minimum where steps overshoot that.
auto ShiftedLog() {
  return SumOfSquares<1, 1>(
      "log",
      [](const auto* x, auto* u) {
        using std::log;
        u[0] = log(x[0]) + 30.0;
      },
      false);
}

TEST_P(EveryBackend, WithNothingToChooseThePointIsJudged) {
  // Every block is eliminated, and all are 0.
  const AffineLift none{.reduced_blocks = 0, .block = {-1, -1}, .coefficient = {0.0, 0.0}};
  for (const double least : {-1.0, 1.0}) {
    Problem problem = Scalars(2);
    problem.AddTerm(Rosenbrock(), Role::kCost);
    const auto row = [least](const auto* x, auto* u) { u[0] = least - x[0]; };
    const auto backend = Make();
    if (backend->capabilities().hard_rows) {
      problem.AddTerm(AtMostZero<2, 1>("row", row), Role::kConstraint);
    }
    const View view(problem, none);
    backend->Prepare(view);
    SolverResult result;
    backend->Solve(view, WarmStart(Eigen::VectorXd(0)), {}, &result);
    const bool broken = backend->capabilities().hard_rows && least > 0.0;
    EXPECT_EQ(result.status, broken ? SolveStatus::kInfeasible : SolveStatus::kConverged);
    EXPECT_EQ(result.cost, 1.0);
  }
}

TEST_P(EveryBackend, Rosenbrock) {
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  // Separable approximations need tens of thousands of steps along the curved valley.
  const SolverResult result =
      Solve(problem, Eigen::Vector2d(-1.2, 1.0), {.max_iterations = 100000});
  EXPECT_EQ(result.status, SolveStatus::kConverged) << result.message;
  EXPECT_LT((result.x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-4);
  EXPECT_LT(result.cost, 1e-8);
  ASSERT_EQ(result.cost_by_term.size(), 1u);
  EXPECT_EQ(result.cost_by_term[0].name, "rosenbrock");
  EXPECT_EQ(result.cost_by_term[0].cost, result.cost);
  EXPECT_GT(result.iterations, 1);
  EXPECT_GE(result.evaluations, result.iterations);
}

TEST_P(EveryBackend, ConvexQuadraticWithKnownSolution) {
  // |A x - b|^2 with A = [2 1 0; 0 3 1; 1 0 4]: x = A^-1 b.
  Problem problem = Scalars(3);
  problem.AddTerm(SumOfSquares<3, 3>(
                      "quadratic",
                      [](const auto* x, auto* u) {
                        u[0] = 2.0 * x[0] + x[1] - 1.0;
                        u[1] = 3.0 * x[1] + x[2] - 2.0;
                        u[2] = x[0] + 4.0 * x[2] - 3.0;
                      },
                      true),
                  Role::kCost);
  EXPECT_TRUE(problem.convex());
  Eigen::Matrix3d A;
  A << 2, 1, 0, 0, 3, 1, 1, 0, 4;
  const Eigen::Vector3d expected = A.inverse() * Eigen::Vector3d(1, 2, 3);
  const SolverResult result = Solve(problem, Eigen::Vector3d(10, -10, 5));
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT((result.x - expected).norm(), 1e-6);
}

TEST_P(EveryBackend, NanIsAStatusAndTheBestPointSurvives) {
  Problem problem = Scalars(1);
  problem.AddTerm(ShiftedLog(), Role::kCost);
  const SolverResult bad = Solve(problem, Eigen::VectorXd::Constant(1, -1.0));
  EXPECT_EQ(bad.status, SolveStatus::kEvaluationFailed);
  const SolverResult good = Solve(problem, Eigen::VectorXd::Constant(1, 1.0));
  EXPECT_TRUE(std::isfinite(good.cost));
  EXPECT_LE(good.cost, 900.0);
}

TEST_P(EveryBackend, ATermThatThrowsIsAStatus) {
  Problem problem = Scalars(1);
  problem.AddTerm(
      SumOfSquares<1, 1>(
          "throws", [](const auto*, auto*) { throw std::runtime_error("term"); }, false),
      Role::kCost);
  EXPECT_EQ(Solve(problem, Eigen::VectorXd::Zero(1)).status, SolveStatus::kEvaluationFailed);
}

/// (h - target)^2 + (x - h)^2: a free interval alone decides.
struct IntervalMap {
  static constexpr int kBlockSize = 1, kWindow = 1, kOutputs = 2;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = true;
  double target;
  int windows() const { return 1; }
  int first_block(int /*k*/) const { return 0; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    u[0] = h - target;
    u[1] = q[0] - h;
  }
};

TEST_P(EveryBackend, AFreeIntervalStaysInItsBoundsOrIsRefused) {
  // Inside, beyond either bound, started at a bound, and with no choice.
  for (const auto& [target, start, h, longest] : {std::array{0.3, 0.5, 0.3, 2.0},
                                                  {0.01, 0.5, 0.1, 2.0},
                                                  {5.0, 0.5, 2.0, 2.0},
                                                  {0.3, 2.0, 0.3, 2.0},
                                                  {0.3, 0.1, 0.1, 0.1}}) {
    Problem problem({.blocks = 1,
                     .block_size = 1,
                     .free_interval = true,
                     .interval_min = 0.1,
                     .interval_max = longest});
    problem.AddTerm(
        std::make_shared<WindowTerm<IntervalMap, SquareLoss>>(
            TermInfo{"interval", "", "", "", false}, IntervalMap{target}, SquareLoss(2.0), 1),
        Role::kCost);
    const auto backend = Make();
    if (!backend->capabilities().free_interval) {
      const View view(problem);
      EXPECT_EQ(backend->Refusal(view),
                "backend " + GetParam() + " cannot optimise the arrival time");
      EXPECT_THROW(backend->Prepare(view), std::invalid_argument);
      continue;
    }
    Stop stop;
    stop.callback = [](const StopQuery& query) {
      EXPECT_GE(query.y[1], 0.1 * (1.0 - 1e-12));
      EXPECT_LE(query.y[1], 2.0 * (1.0 + 1e-12));
      return false;
    };
    const SolverResult result = Solve(problem, Eigen::Vector2d(1.0, start), stop);
    EXPECT_EQ(result.status, SolveStatus::kConverged)
        << ToString(result.status) << ": " << result.message << " target " << target;
    EXPECT_NEAR(result.x[1], h, 1e-4);
    EXPECT_NEAR(result.x[0], h, 1e-4);
    if (!result.bound_multipliers.empty() && longest > 0.1) {
      EXPECT_NEAR(result.bound_multipliers.back(), -2.0 * (h - target), 1e-4);
    }
  }
}

TEST_P(EveryBackend, TellsEveryIterationAndWhereTheTimeWent) {
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  Stop stop;
  stop.trace = stop.shares = true;
  const SolverResult result = Solve(problem, Eigen::Vector2d(-1.2, 1.0), stop);
  ASSERT_EQ(static_cast<int>(result.trace.size()), result.iterations);
  for (std::size_t i = 0; i < result.trace.size(); ++i) {
    EXPECT_EQ(result.trace[i].iteration, static_cast<int>(i) + 1);
    EXPECT_LE(result.trace[i].cost, result.trace[i > 0 ? i - 1 : 0].cost) << "the best so far";
    EXPECT_FALSE(result.trace[i].step_norm < 0.0);
  }
  EXPECT_EQ(result.trace.back().cost, result.cost);
  EXPECT_LT(result.cost, 0.3);  // nlopt-ccsaq is slow along the valley
  EXPECT_GT(result.trace.front().cost, 1.0) << "of the first iteration, not of the last";
  const SolveShares& s = result.shares;
  EXPECT_NEAR(s.evaluation_s + s.whitening_s + s.native_s + s.adapter_s, result.wall_s,
              1e-3 * result.wall_s + 1e-4);
  EXPECT_GT(s.evaluation_s, 0.0);
  EXPECT_GT(s.native_s, 0.0);
}

TEST_P(EveryBackend, PrintsNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  for (const int budget : {1, 2, 3, 5, 8, 1000}) {
    Solve(problem, Eigen::Vector2d(-1.2, 1.0), {.max_iterations = budget});
    Solve(problem, Eigen::Vector2d(-1.2, 1.0), {.max_evaluations = budget});
  }
  Problem broken = Scalars(1);
  broken.AddTerm(ShiftedLog(), Role::kCost);
  for (const double start : {-1.0, 1.0}) Solve(broken, Eigen::VectorXd::Constant(1, start));
  const StandardProblem infeasible = Infeasible();
  const View view(*infeasible.problem);
  if (Make()->Refusal(view).empty()) Solve(*infeasible.problem, infeasible.start);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(EveryBackend, AnExceptionOfTheCallbackReachesTheCaller) {
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  for (const int when : {1, 4}) {
    Stop stop;
    int asked = 0;
    stop.callback = [&](const StopQuery&) {
      if (++asked == when) throw std::runtime_error("caller");
      return false;
    };
    EXPECT_THROW(Solve(problem, Eigen::Vector2d(-1.2, 1.0), stop), std::runtime_error);
  }
  EXPECT_EQ(Solve(problem, Eigen::Vector2d(-1.2, 1.0)).status != SolveStatus::kEvaluationFailed,
            true);
}

TEST_P(EveryBackend, StopsOnBudgetCallbackAndClock) {
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  const Eigen::Vector2d start(-1.2, 1.0);

  Stop iterations;
  iterations.max_iterations = 5;
  const SolverResult few = Solve(problem, start, iterations);
  EXPECT_EQ(few.status, SolveStatus::kIterationLimit);
  EXPECT_LE(few.iterations, 5);
  EXPECT_LT(few.cost, 0.9 * 24.2) << "the start's: it would be told without any step";

  for (const int budget : {1, 2, 3, 5, 8}) {
    EXPECT_LE(Solve(problem, start, {.max_evaluations = budget}).evaluations, budget);
  }

  Stop callback;
  int asked = 0;
  callback.callback = [&](const StopQuery& query) {
    EXPECT_EQ(query.y.size(), 2u);
    EXPECT_EQ(query.cost_by_term.size(), 1u);
    return ++asked >= 3;
  };
  EXPECT_EQ(Solve(problem, start, callback).status, SolveStatus::kStopped);

  Stop clock;
  clock.wall_limit_s = 0.0;
  const SolverResult late = Solve(problem, start, clock);
  EXPECT_EQ(late.status, SolveStatus::kTimeLimit);
  EXPECT_TRUE(late.x.allFinite());
}

TEST_P(EveryBackend, RefusesConstraintsItCannotTake) {
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kConstraint);  // a square loss: equality rows
  const View view(problem);
  auto backend = Make();
  if (backend->capabilities().equality_rows) {
    EXPECT_EQ(backend->Refusal(view), "");
  } else {
    EXPECT_NE(backend->Refusal(view).find("rosenbrock"), std::string::npos);
    EXPECT_THROW(backend->Prepare(view), std::invalid_argument);
  }
}

TEST_P(EveryBackend, RefusesMisuse) {
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  const View view(problem);
  auto backend = Make();
  SolverResult result;
  EXPECT_THROW(backend->Solve(view, WarmStart(Eigen::VectorXd::Zero(2)), {}, &result),
               std::invalid_argument);
  backend->Prepare(view);
  EXPECT_THROW(backend->Solve(view, WarmStart(Eigen::VectorXd::Zero(3)), {}, &result),
               std::invalid_argument);
  EXPECT_THROW(
      backend->Solve(view, WarmStart(Eigen::VectorXd::Constant(2, std::nan(""))), {}, &result),
      std::invalid_argument);
  EXPECT_THROW(backend->options().Set("no_such_option", 1.0), std::invalid_argument);
  // As many variables, but another structure.
  Problem other = Scalars(2);
  other.AddTerm(Rosenbrock(), Role::kCost);
  other.AddTerm(Rosenbrock(), Role::kCost);
  const View other_view(other);
  EXPECT_THROW(backend->Solve(other_view, WarmStart(Eigen::VectorXd::Zero(2)), {}, &result),
               std::invalid_argument);
}

TEST_P(EveryBackend, TwoThreadsGiveTheBitsOfOne) {
  const StandardProblem constrained = Projection();
  const View view(*constrained.problem);
  const bool rows = Make()->Refusal(view).empty();
  const auto run = [&]() -> Eigen::VectorXd {
    if (rows) return Solve(*constrained.problem, constrained.start).x;
    Problem problem = Scalars(2);
    problem.AddTerm(Rosenbrock(), Role::kCost);
    return Solve(problem, Eigen::Vector2d(-1.2, 1.0)).x;
  };
  const Eigen::VectorXd alone = run();
  for (int repeat = 0; repeat < 20; ++repeat) {
    Eigen::VectorXd a, b;
    std::thread one([&] { a = run(); }), two([&] { b = run(); });
    one.join();
    two.join();
    EXPECT_EQ(a, alone);
    EXPECT_EQ(b, alone);
  }
}

// A build without any backend has nothing to run here.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryBackend);
INSTANTIATE_TEST_SUITE_P(Backends, EveryBackend, ::testing::ValuesIn(CompiledBackends()), TestName);

TEST(Refusal, IsASentenceWithTheReason) {
  Problem squares = Scalars(2);
  squares.AddTerm(Rosenbrock(), Role::kCost);
  const View view(squares);
  const auto missing = MakeMissingBackend("somebody");
  EXPECT_FALSE(missing->capabilities().compiled);
  EXPECT_NE(missing->Refusal(view).find("somebody was not compiled in"), std::string::npos);
  EXPECT_THROW(missing->Prepare(view), std::invalid_argument);

  const StandardProblem linear = Hs35();
  const View linear_view(*linear.problem);
  for (const BackendEntry& entry : StandardBackends()) {
    const auto backend = entry.make();
    const Capabilities can = backend->capabilities();
    if (!can.compiled) {
      EXPECT_NE(backend->Refusal(view), "");
      continue;
    }
    EXPECT_EQ(backend->Refusal(view), "") << entry.name;
    if (can.needs_residuals) {
      EXPECT_NE(backend->Refusal(linear_view).find("sums of squares"), std::string::npos);
    }
  }
}

TEST(BackendRegistry, NamesWhatItKnows) {
  try {
    MakeBackend(StandardBackends(), "simplex");
    FAIL() << "an unknown backend was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("simplex"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("ceres"), std::string::npos);
  }
}

}  // namespace
}  // namespace touchdown::solvers
