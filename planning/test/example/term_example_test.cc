// SPDX-License-Identifier: BSD-3-Clause
// docs/examples/in_tree_term: compiled with one more line in terms.def and nothing else, it is part
// of StandardTerms() and has the right derivatives. Every backend solves it, soft and hard, or
// refuses it with a sentence that names it.

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/problem/term_check.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {
namespace {

constexpr char kName[] = "lowest_height";
constexpr double kHeight = 2.6;  // [m], above both ends

int Lines(const std::string& path) {
  std::ifstream file(std::string(TOUCHDOWN_SOURCE_DIR) + "/" + path);
  EXPECT_TRUE(file.good()) << path;
  int lines = 0;
  for (std::string line; std::getline(file, line);) ++lines;
  return lines;
}

TEST(TermExample, IsShortAndRegisteredByOneLine) {
  EXPECT_LE(Lines("docs/examples/in_tree_term/lowest_height.cc"), 40);
  EXPECT_LE(Lines("docs/examples/own_program/main.cc"), 40);
  const TermRegistry terms = StandardTerms();
  EXPECT_EQ(FindTerm(terms, kName).default_weight, 0.0);
}

TEST(TermExample, HasTheRightDerivatives) {
  const TermRegistry terms = StandardTerms();
  EXPECT_TRUE(Passed(CheckTerm(FindTerm(terms, kName), {})));
}

/// Lowest free control point of the solved landing; the term is off where `settings` is empty.
double LowestSolved(solvers::SolverBackend* backend, ArrivalMode arrival,
                    const std::vector<TermSettings>& settings) {
  LandingProblemOptions options;
  options.arrival = arrival;
  options.settings = settings;
  LandingProblem problem(20, options);
  const ArcPad pad({6.0, 2.0, 0.5}, 0.8, 0.3, 0.2);
  SplineState start;
  start.p = {0.0, 0.0, 2.0};
  problem.SetBoundary(start, 0.0, pad, {0.0, 1.5, 0.0, 1.5});
  problem.SetDuration(5.0);
  backend->Prepare(problem.view());
  solvers::SolverResult result;
  backend->Solve(problem.view(), problem.Guess(), {.max_iterations = 500}, &result);
  EXPECT_TRUE(result.usable()) << result.message;
  const UniformBspline curve = problem.Curve(result.x);
  return curve.control_points().row(2).segment(3, curve.segments() - 3).minCoeff();
}

TEST(TermExample, IsSolvedByEveryBackendSoftAndHard) {
  const TermSettings soft{kName, 1000.0, false, {{"height", kHeight}}};
  const TermSettings hard{kName, {}, true, {{"height", kHeight}}};
  const solvers::BackendRegistry backends = solvers::StandardBackends();
  for (const solvers::BackendEntry& entry : backends) {
    for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
      SCOPED_TRACE(entry.name + (arrival == ArrivalMode::kFree ? " free" : " fixed"));
      const auto backend = entry.make();
      if (!backend->capabilities().compiled) continue;
      EXPECT_LT(LowestSolved(backend.get(), arrival, {}), 2.1);
      EXPECT_GT(LowestSolved(backend.get(), arrival, {soft}), 2.3);
      if (backend->capabilities().hard_rows) {
        EXPECT_GT(LowestSolved(backend.get(), arrival, {hard}), kHeight - 2e-6);
        continue;
      }
      LandingProblemOptions options;
      options.settings = {hard};
      const LandingProblem refused(20, options);
      EXPECT_THAT(backend->Refusal(refused.view()), testing::HasSubstr(kName));
    }
  }
}

}  // namespace
}  // namespace touchdown::planning
