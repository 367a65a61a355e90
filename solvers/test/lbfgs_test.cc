// SPDX-License-Identifier: BSD-3-Clause
// Our L-BFGS on standard functions: its stop test, its budget, its cancel callback, and functions
// that cannot be evaluated everywhere. Its line search is tested against its two conditions.

#include "solvers/lbfgs/lbfgs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "solvers/test/every_backend.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::solvers {
namespace {

class Function : public LbfgsFunction {
 public:
  using Value = std::function<double(const Eigen::VectorXd&, Eigen::VectorXd*)>;
  explicit Function(Value value) : value_(std::move(value)) {}

  double Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override {
    ++evaluations;
    last = x;
    return value_(x, gradient);
  }
  bool Cancelled() override { return evaluations >= cancel_after; }
  void Accepted(double value, const Eigen::VectorXd&) override { values.push_back(value); }

  int evaluations = 0;
  int cancel_after = std::numeric_limits<int>::max();
  Eigen::VectorXd last;
  std::vector<double> values;

 private:
  Value value_;
};

/// Extended Rosenbrock (More, Garbow, Hillstrom 1981, no. 21).
double Rosenbrock(const Eigen::VectorXd& x, Eigen::VectorXd* g) {
  double f = 0.0;
  for (int i = 0; i < x.size(); i += 2) {
    const double a = 10.0 * (x[i + 1] - x[i] * x[i]), b = 1.0 - x[i];
    f += a * a + b * b;
    (*g)[i] = -40.0 * x[i] * a - 2.0 * b;
    (*g)[i + 1] = 20.0 * a;
  }
  return f;
}

/// Powell's singular function (no. 13): its Hessian is singular at the minimum 0.
double Powell(const Eigen::VectorXd& x, Eigen::VectorXd* g) {
  const double a = x[0] + 10.0 * x[1], b = x[2] - x[3], c = x[1] - 2.0 * x[2], d = x[0] - x[3];
  (*g)[0] = 2.0 * a + 40.0 * d * d * d;
  (*g)[1] = 20.0 * a + 4.0 * c * c * c;
  (*g)[2] = 10.0 * b - 8.0 * c * c * c;
  (*g)[3] = -10.0 * b - 40.0 * d * d * d;
  return a * a + 5.0 * b * b + c * c * c * c + 10.0 * d * d * d * d;
}

LbfgsResult Minimize(Function* function, Eigen::VectorXd* x, LbfgsOptions options = {}) {
  Lbfgs lbfgs;
  lbfgs.Prepare(static_cast<int>(x->size()));
  return lbfgs.Minimize(options, function, x);
}

TEST(Lbfgs, ExtendedRosenbrock) {
  Function function(Rosenbrock);
  Eigen::VectorXd x(20);
  for (int i = 0; i < 20; i += 2) x.segment<2>(i) = Eigen::Vector2d(-1.2, 1.0);
  const LbfgsResult result = Minimize(&function, &x, {.gradient_tolerance = 1e-8});
  EXPECT_EQ(result.status, LbfgsStatus::kConverged) << ToString(result.status);
  EXPECT_LT((x.array() - 1.0).abs().maxCoeff(), 1e-7);
  EXPECT_LT(result.iterations, 60);
  EXPECT_EQ(result.evaluations, function.evaluations);
  EXPECT_EQ(static_cast<int>(function.values.size()), result.iterations);
  EXPECT_TRUE(std::is_sorted(function.values.rbegin(), function.values.rend()));
  EXPECT_EQ(result.value, function.values.back());
}

TEST(Lbfgs, PowellsSingularFunction) {
  Function function(Powell);
  Eigen::VectorXd x = Eigen::Vector4d(3.0, -1.0, 0.0, 1.0);
  const LbfgsResult result = Minimize(&function, &x, {.gradient_tolerance = 1e-7});
  EXPECT_EQ(result.status, LbfgsStatus::kConverged);
  EXPECT_LT(result.value, 1e-8);
}

TEST(Lbfgs, IllConditionedQuadratic) {
  Function function([](const Eigen::VectorXd& x, Eigen::VectorXd* g) {
    double f = 0.0;
    for (int i = 0; i < x.size(); ++i) {
      const double weight = std::pow(10.0, 4.0 * i / (x.size() - 1));
      (*g)[i] = weight * (x[i] - i);
      f += 0.5 * weight * (x[i] - i) * (x[i] - i);
    }
    return f;
  });
  Eigen::VectorXd x = Eigen::VectorXd::Zero(30);
  const LbfgsResult result =
      Minimize(&function, &x, {.gradient_tolerance = 1e-9, .max_iterations = 2000});
  EXPECT_EQ(result.status, LbfgsStatus::kConverged);
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(x[i], i, 1e-6);
}

TEST(Lbfgs, StopsByTheGradientInUnitsOfThePoint) {
  const auto bowl = [](double centre) {
    return [centre](const Eigen::VectorXd& x, Eigen::VectorXd* g) {
      *g = x.array() - centre;
      return 0.5 * g->squaredNorm();
    };
  };
  // |g| = 1 at |x| = 99: within 1 % of the point, not within 1 % of one.
  Function near_origin(bowl(0.0)), far_away(bowl(100.0));
  Eigen::VectorXd a = Eigen::VectorXd::Constant(1, 1.0);
  Eigen::VectorXd b = Eigen::VectorXd::Constant(1, 99.0);
  EXPECT_EQ(Minimize(&near_origin, &a, {.gradient_tolerance = 0.011}).status,
            LbfgsStatus::kConverged);
  const LbfgsResult result = Minimize(&far_away, &b, {.gradient_tolerance = 0.011});
  EXPECT_EQ(result.status, LbfgsStatus::kAlreadyMinimized);
  EXPECT_EQ(result.evaluations, 1);
  EXPECT_EQ(result.iterations, 0);
}

TEST(Lbfgs, TheFirstStepHasUnitLength) {
  Function function([](const Eigen::VectorXd& x, Eigen::VectorXd* g) {
    g->setConstant(3.0);
    return 3.0 * x.sum();
  });
  function.cancel_after = 2;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(4);
  Minimize(&function, &x);
  EXPECT_NEAR(function.last.norm(), 1.0, 1e-12);
}

TEST(Lbfgs, EndsOnItsBudgetAndOnCancel) {
  Eigen::VectorXd start = Eigen::Vector2d(-1.2, 1.0), gradient(2);
  Function budget(Rosenbrock);
  Eigen::VectorXd x = start;
  EXPECT_EQ(Minimize(&budget, &x, {.max_iterations = 3}).status, LbfgsStatus::kIterationLimit);
  EXPECT_EQ(x, budget.last);

  for (int after = 0; after < 12; ++after) {
    Function cancelled(Rosenbrock);
    cancelled.cancel_after = after;
    x = start;
    const LbfgsResult result = Minimize(&cancelled, &x);
    EXPECT_EQ(result.status, LbfgsStatus::kCancelled);
    EXPECT_EQ(result.evaluations, after);
    if (after > 0) {
      EXPECT_EQ(result.value, Rosenbrock(x, &gradient));
    }
  }
}

TEST(Lbfgs, BacksOffWhereTheFunctionIsNotDefined) {
  // x - log x, defined for x > 0: the first step from 0.5 along the gradient leaves the domain.
  Function function([](const Eigen::VectorXd& x, Eigen::VectorXd* g) {
    (*g)[0] = 1.0 - 1.0 / x[0] + 1e3 * (x[0] - 0.02);
    return x[0] - std::log(x[0]) + 5e2 * (x[0] - 0.02) * (x[0] - 0.02);
  });
  Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 0.5);
  const LbfgsResult result = Minimize(&function, &x, {.gradient_tolerance = 1e-8});
  EXPECT_EQ(result.status, LbfgsStatus::kConverged) << ToString(result.status);
  EXPECT_NEAR(1.0 - 1.0 / x[0] + 1e3 * (x[0] - 0.02), 0.0, 1e-6);

  Eigen::VectorXd outside = Eigen::VectorXd::Constant(1, -0.5);
  EXPECT_EQ(Minimize(&function, &outside).status, LbfgsStatus::kEvaluationFailed);
}

TEST(Lbfgs, AFunctionWithoutMinimumFailsInTheLineSearch) {
  Function function([](const Eigen::VectorXd& x, Eigen::VectorXd* g) {
    (*g)[0] = -1.0;
    return -x[0];
  });
  Eigen::VectorXd x = Eigen::VectorXd::Zero(1);
  const LbfgsResult result = Minimize(&function, &x);
  EXPECT_EQ(result.status, LbfgsStatus::kLineSearchFailed);
  EXPECT_EQ(x[0], 0.0);
}

TEST(Lbfgs, RefusesMisuse) {
  Lbfgs lbfgs;
  EXPECT_THROW(lbfgs.Prepare(0), std::invalid_argument);
  EXPECT_THROW(lbfgs.Prepare(2, 0), std::invalid_argument);
  Function function(Rosenbrock);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  EXPECT_THROW(lbfgs.Minimize({}, &function, &x), std::invalid_argument);
  lbfgs.Prepare(4);
  EXPECT_THROW(lbfgs.Minimize({}, &function, &x), std::invalid_argument);
}

TEST(Lbfgs, DoesNotAllocateAndRepeats) {
  Function function(Rosenbrock);
  Lbfgs lbfgs;
  lbfgs.Prepare(10, 5);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(10);
  function.values.reserve(1000);
  const int first = lbfgs.Minimize({}, &function, &x).iterations;
  const Eigen::VectorXd once = x;
  x.setZero();
  const long before = AllocationCount();
  const int second = lbfgs.Minimize({}, &function, &x).iterations;
  EXPECT_EQ(AllocationCount(), before);
  EXPECT_EQ(first, second);
  EXPECT_EQ(x, once);
}

TEST(MoreThuente, MeetsBothConditions) {
  // The paper's test functions 1 and 2 (section 5), from its six first steps.
  struct Case {
    std::function<std::pair<double, double>(double)> f;
    double mu, eta;
  };
  const auto one = [](double a) {
    const double b = 2.0, d = a * a + b;
    return std::pair{-a / d, (a * a - b) / (d * d)};
  };
  const auto two = [](double a) {
    const double c = a + 0.004;
    return std::pair{std::pow(c, 5) - 2.0 * std::pow(c, 4),
                     5.0 * std::pow(c, 4) - 8.0 * std::pow(c, 3)};
  };
  for (const Case& test : {Case{one, 1e-3, 0.1}, Case{two, 0.1, 0.1}, Case{one, 1e-4, 0.9}}) {
    const auto [f0, d0] = test.f(0.0);
    for (const double step : {1e-3, 1e-1, 1e1, 1e3}) {
      MoreThuente search;
      search.Begin(f0, d0, step, {.sufficient_decrease = test.mu, .curvature = test.eta});
      int evaluations = 0;
      while (search.state() == LineSearchState::kEvaluate) {
        const auto [f, d] = test.f(search.step());
        search.Observe(f, d);
        ++evaluations;
      }
      EXPECT_EQ(search.state(), LineSearchState::kConverged) << step;
      const auto [f, d] = test.f(search.step());
      EXPECT_LE(f, f0 + test.mu * search.step() * d0);
      EXPECT_LE(std::abs(d), test.eta * std::abs(d0));
      EXPECT_LE(evaluations, 16);
    }
  }
}

TEST(LbfgsSolver, AClaimOfTheLastIterationAllowedIsLookedAt) {
  Problem problem = Scalars(2);
  problem.AddTerm(solvers::Rosenbrock(), Role::kCost);
  const View view(problem);
  const auto solver = MakeBackend(StandardBackends(), "lbfgs");
  solver->Prepare(view);
  SolverResult result;
  const Eigen::Vector2d start(-1.2, 1.0);
  solver->Solve(view, WarmStart(start), {.max_iterations = 500}, &result);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  const int used = result.iterations;
  solver->Solve(view, WarmStart(start), {.max_iterations = used}, &result);
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  solver->Solve(view, WarmStart(start), {.max_iterations = used - 1}, &result);
  EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
}

}  // namespace
}  // namespace touchdown::solvers
