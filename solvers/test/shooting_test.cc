// SPDX-License-Identifier: BSD-3-Clause
// The set of multiple-shooting problems: every backend that takes one finds the same optimum, or
// claims none.

#include "touchdown/solvers/problems/shooting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solvers/test/every_backend.h"
#include "touchdown/solvers/backend/constraint_rows.h"

namespace touchdown::solvers {
namespace {

SolverResult Solve(const ReferenceProblem& p, SolverBackend* backend) {
  const View view(*p.problem);
  backend->Prepare(view);
  SolverResult result;
  backend->Solve(view, WarmStart(p.start), {.max_iterations = 300}, &result);
  return result;
}

TEST(ShootingProblems, BandedAndIpoptMeetAtTheSameOptimum) {
  const auto ipopt = MakeBackend(StandardBackends(), "ipopt");
  if (ipopt->capabilities().compiled) ipopt->options().Set("tolerance", 1e-10);
  const auto problems = ShootingProblems();
  EXPECT_EQ(problems.size(), 10u);
  for (const ReferenceProblem& p : problems) {
    const SolverResult result = Solve(p, MakeBackend(StandardBackends(), "banded").get());
    EXPECT_EQ(result.status, SolveStatus::kConverged) << p.name << ": " << ToString(result.status);
    EXPECT_LE(result.iterations, 20) << p.name;
    EXPECT_LE(result.max_violation, 1e-8) << p.name;
    if (!ipopt->capabilities().compiled) continue;
    const SolverResult reference = Solve(p, ipopt.get());
    EXPECT_EQ(reference.status, SolveStatus::kConverged) << p.name;
    EXPECT_NEAR(result.cost, reference.cost, 1e-8 * reference.cost) << p.name;
  }
}

TEST(ShootingProblems, DerivativesAreRight) {
  for (const ReferenceProblem& p : ShootingProblems()) {
    const View view(*p.problem);
    Eigen::VectorXd y = p.start;
    for (Eigen::Index i = 0; i < y.size(); ++i)
      y[i] += 0.1 * std::sin(7.0 * static_cast<double>(i));
    ViewEvaluation at, near;
    view.Resize(&at);
    view.Resize(&near);
    // The Lagrangian with some multipliers, along one direction.
    std::vector<std::vector<double>> multipliers;
    ConstraintRows::Size(view, &multipliers);
    std::vector<RowWeights> rows(multipliers.size());
    for (std::size_t i = 0; i < multipliers.size(); ++i) {
      for (std::size_t j = 0; j < multipliers[i].size(); ++j) {
        multipliers[i][j] = std::cos(3.0 * static_cast<double>(j));
      }
      rows[i].multiplier = multipliers[i].empty() ? nullptr : multipliers[i].data();
    }
    const Lagrangian lagrangian{.rows = rows.data()};
    Eigen::VectorXd step(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i)
      step[i] = std::sin(5.0 * static_cast<double>(i) + 1.0);
    ASSERT_TRUE(view.Evaluate(y.data(), {.gradient = true, .hessian = true}, lagrangian, &at));
    std::vector<double> curved(static_cast<std::size_t>(y.size()));
    at.hessian.Multiply(step.data(), curved.data());
    const double d = 1e-5;
    std::vector<std::vector<double>> slopes;
    for (const double side : {1.0, -1.0}) {
      const Eigen::VectorXd z = y + side * d * step;
      ASSERT_TRUE(view.Evaluate(z.data(), {.gradient = true, .hessian = true}, lagrangian, &near));
      std::vector<double> slope = near.gradient;
      std::vector<const double*> weights(multipliers.size(), nullptr);
      for (std::size_t i = 0; i < multipliers.size(); ++i) weights[i] = rows[i].multiplier;
      std::vector<double> of_rows(slope.size());
      view.MultiplyRowsTransposed(weights.data(), &near, of_rows.data());
      for (std::size_t i = 0; i < slope.size(); ++i) slope[i] += of_rows[i];
      slopes.push_back(slope);
    }
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < curved.size(); ++i) {
      worst = std::max(worst, std::abs(curved[i] - (slopes[0][i] - slopes[1][i]) / (2.0 * d)));
      largest = std::max(largest, std::abs(curved[i]));
    }
    EXPECT_LE(worst, 1e-6 * largest) << p.name;
  }
}

}  // namespace
}  // namespace touchdown::solvers
