// SPDX-License-Identifier: BSD-3-Clause
// Problems with constraint rows on every backend that takes rows: known optima, infeasibility, rows
// that cannot be evaluated, multipliers.

#include "solvers/test/every_backend.h"
#include "touchdown/solvers/problems/reference_problem.h"

namespace touchdown::solvers {
namespace {

class EveryRowBackend : public EveryBackend {};

TEST_P(EveryRowBackend, ConstrainedProblemsHaveTheirKnownOptima) {
  int solved = 0, confirmed = 0;
  for (const StandardProblem& standard : ConstrainedProblems()) {
    SCOPED_TRACE(standard.name);
    const View view(*standard.problem);
    auto backend = Make();
    if (!backend->Refusal(view).empty()) continue;
    ++solved;
    backend->Prepare(view);
    SolverResult result;
    backend->Solve(view, standard.start, {.max_iterations = 10000}, &result);
    // Loose default tolerances may leave more than the check confirms.
    EXPECT_TRUE(result.status == SolveStatus::kConverged ||
                result.status == SolveStatus::kUnconfirmed)
        << ToString(result.status) << ": " << result.message;
    confirmed += result.status == SolveStatus::kConverged;
    EXPECT_NEAR(result.cost, standard.cost, 1e-6 * std::max(1.0, std::abs(standard.cost)));
    EXPECT_LE(result.max_violation, 1e-6);
    EXPECT_LT((result.x - standard.optimum).norm(), 1e-3);
  }
  EXPECT_GT(solved, 0);  // a backend that takes rows takes some of these
  EXPECT_GT(2 * confirmed, solved);
}

TEST_P(EveryRowBackend, InfeasibleIsAStatus) {
  const StandardProblem p = Infeasible();
  const View view(*p.problem);
  ASSERT_EQ(Make()->Refusal(view), "");
  const SolverResult result = Solve(*p.problem, p.start, {.max_iterations = 1000});
  EXPECT_EQ(result.status, SolveStatus::kInfeasible)
      << ToString(result.status) << ": " << result.message;
  EXPECT_TRUE(result.x.allFinite());
  EXPECT_GT(result.max_violation, 0.9);
}

TEST_P(EveryRowBackend, RowsThatContradictEachOtherAreInfeasible) {
  // Linear equalities and, for all, circles that do not meet. The unit of the second variable says
  // which row a point of least violation leaves.
  for (const double unit : {1e-2, 1.0, 1e2}) {
    for (const bool linear : {true, false}) {
      if (linear && !Make()->capabilities().equality_rows) continue;
      SmallProblem made("contradiction", {0.0, 0.0}, 0.0, EqualityForm::kRows);
      made.Squares(2, [=](const auto* x, auto* u) {
        u[0] = x[0] - 1.0;
        u[1] = x[1] / unit - 1.0;
      });
      if (linear) {
        made.Zero(3, [=](const auto* x, auto* u) {
          u[0] = x[0] - 2.0;
          u[1] = x[1] / unit + 1.0;
          u[2] = x[0] + x[1] / unit - 2.0;
        });
      } else {
        made.AtLeastZero(2, [=](const auto* x, auto* u) {
          const auto a = x[0] - 2.0, b = x[1] / unit + 2.0;
          u[0] = 1.0 - a * a - b * b;
          u[1] = 1.0 - x[0] * x[0] - (b - 3.0) * (b - 3.0);
        });
      }
      const ReferenceProblem p = made;
      const SolverResult result = Solve(*p.problem, p.start, {.max_iterations = 1000});
      EXPECT_EQ(result.status, SolveStatus::kInfeasible)
          << unit << (linear ? " linear" : " circles") << ": " << result.message;
    }
  }
}

TEST_P(EveryRowBackend, ARowThatCannotBeEvaluatedIsAStatus) {
  // sqrt(x) >= 1 from x < 0, and from x > 0 where a long step leaves the domain.
  StandardProblem p = Standard("Root", {-1.0}, {1.0}, 1.0);
  p.problem->AddTerm(
      Whole<1, 1>("square", SquareLoss(2.0), [](const auto* x, auto* u) { u[0] = x[0]; }),
      Role::kCost);
  p.problem->AddTerm(AtMostZero<1, 1>("root",
                                      [](const auto* x, auto* u) {
                                        using std::sqrt;
                                        u[0] = 1.0 - sqrt(x[0]);
                                      }),
                     Role::kConstraint);
  const View view(*p.problem);
  ASSERT_EQ(Make()->Refusal(view), "");
  EXPECT_EQ(Solve(*p.problem, p.start).status, SolveStatus::kEvaluationFailed);
  const SolverResult good = Solve(*p.problem, Eigen::VectorXd::Constant(1, 9.0));
  EXPECT_NEAR(good.cost, 1.0, 1e-5) << ToString(good.status) << ": " << good.message;
}

TEST_P(EveryRowBackend, MultipliersSatisfyStationarity) {
  const StandardProblem p = Projection();
  const View view(*p.problem);
  ASSERT_EQ(Make()->Refusal(view), "");
  const SolverResult result = Solve(*p.problem, p.start);
  if (GetParam().starts_with("nlopt")) {
    EXPECT_TRUE(result.multipliers.empty());  // NLopt has none to give
    return;
  }
  ASSERT_EQ(result.multipliers.size(), 2u);
  ASSERT_EQ(result.multipliers[1].size(), 7u);
  const double expected[] = {2.5, 0.5, 0.0, 0.0, 0.0, 0.0, 4.5};
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(result.multipliers[1][i], expected[i], 1e-4);

  // Point and multipliers together are a start that can hardly be improved.
  auto backend = Make();
  backend->Prepare(view);
  SolverResult again;
  backend->Solve(view, WarmStart(result.x, result.multipliers), {}, &again);
  EXPECT_EQ(again.status, SolveStatus::kConverged) << again.message;
  EXPECT_LE(again.iterations, result.iterations);
  EXPECT_NEAR(again.cost, result.cost, 1e-6 * result.cost);
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryRowBackend);
INSTANTIATE_TEST_SUITE_P(Backends, EveryRowBackend, ::testing::ValuesIn(CompiledBackends(true)),
                         TestName);

}  // namespace
}  // namespace touchdown::solvers
