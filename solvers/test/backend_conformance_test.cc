// SPDX-License-Identifier: BSD-3-Clause
// The same standard problems on every backend that can take them, and the same answers to misuse,
// NaN, exhausted budgets and two threads.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <thread>

#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/test/test_terms.h"

namespace touchdown::solvers {
namespace {

class EveryBackend : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<SolverBackend> Make() const {
    return MakeBackend(StandardBackends(), GetParam());
  }

  SolverResult Solve(const Problem& problem, const Eigen::VectorXd& warm, const Stop& stop = {}) {
    const View view(problem, AffineLift::Identity(problem.shape().blocks));
    auto backend = Make();
    backend->Prepare(view);
    SolverResult result;
    backend->Solve(view, warm, stop, &result);
    return result;
  }
};

Problem Scalars(int n) { return Problem({.blocks = n, .block_size = 1}); }

auto Rosenbrock() {
  return SumOfSquares<2, 2>(
      "rosenbrock",
      [](const auto* x, auto* u) {
        u[0] = 10.0 * (x[1] - x[0] * x[0]);
        u[1] = 1.0 - x[0];
      },
      false);
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
  // Defined only for x > 0; the unconstrained minimum lies beyond.
  Problem problem = Scalars(1);
  problem.AddTerm(SumOfSquares<1, 1>(
                      "log",
                      [](const auto* x, auto* u) {
                        using std::log;
                        u[0] = log(x[0]) + 30.0;
                      },
                      false),
                  Role::kCost);
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

TEST_P(EveryBackend, StopsOnBudgetCallbackAndClock) {
  Problem problem = Scalars(2);
  problem.AddTerm(Rosenbrock(), Role::kCost);
  const Eigen::Vector2d start(-1.2, 1.0);

  Stop iterations;
  iterations.max_iterations = 2;
  const SolverResult few = Solve(problem, start, iterations);
  EXPECT_EQ(few.status, SolveStatus::kIterationLimit);
  EXPECT_LE(few.iterations, 2);
  EXPECT_LE(few.cost, 24.2);

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
  const View view(problem, AffineLift::Identity(2));
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
  const View view(problem, AffineLift::Identity(2));
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
  const View other_view(other, AffineLift::Identity(2));
  EXPECT_THROW(backend->Solve(other_view, WarmStart(Eigen::VectorXd::Zero(2)), {}, &result),
               std::invalid_argument);
}

TEST_P(EveryBackend, TwoThreadsGiveTheBitsOfOne) {
  const auto run = [this] {
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

std::vector<std::string> CompiledBackends() {
  std::vector<std::string> names;
  for (const BackendEntry& entry : StandardBackends()) {
    if (entry.make()->capabilities().compiled) names.push_back(entry.name);
  }
  return names;
}

// A build without any backend has nothing to run here.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryBackend);
INSTANTIATE_TEST_SUITE_P(Backends, EveryBackend, ::testing::ValuesIn(CompiledBackends()),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

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
