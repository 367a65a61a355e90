// SPDX-License-Identifier: BSD-3-Clause
// The judge stands outside, failures stay failures.
#include "evaluation/compare/solver_bench.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/compare/compare_report.h"
#include "evaluation/compare/compare_summary.h"
#include "touchdown/planning/problem/landing_problem.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Says that it converged wherever it starts.
class LyingSolver : public solvers::SolverBackend {
 public:
  LyingSolver() : SolverBackend("liar", {}) {}
  solvers::Capabilities capabilities() const override { return {}; }

 private:
  void DoPrepare(const solvers::View&) override {}
  void DoSolve(const solvers::View&, const solvers::WarmStart& warm, const solvers::Stop&,
               solvers::Evaluator* evaluator, solvers::SolverResult* result) override {
    evaluator->Evaluate(warm.y.data(), {});
    result->status = solvers::SolveStatus::kConverged;
  }
};

// A pad that drives straight on.
class StraightPad : public estimation::PadPrediction {
 public:
  estimation::PadState At(double t) const noexcept override {
    estimation::PadState pad;
    pad.v_WP = {1.0, 0.3, 0.0};
    pad.p_WP = Eigen::Vector3d(8.0, 1.0, 0.5) + t * pad.v_WP;
    return pad;
  }
};

// Landings past three planes, drawn from a seed.
class Bench : public ::testing::Test {
 protected:
  void Solve(SolverBench* bench, int problems,
             const planning::LandingProblemOptions& options = {}) {
    planning::LandingProblem problem(16, options);
    for (int i = 0; i < problems; ++i) {
      planning::SplineState start;
      start.p = {Draw(1.0), Draw(2.0), 1.5 + Draw(0.3)};
      start.v = {1.0 + Draw(0.5), Draw(0.5), 0.0};
      problem.SetBoundary(start, 0.0, pad_, {0.0, 0.3, 0.3, -1.0e3});
      problem.SetDuration(6.0);
      const planning::UniformBspline guess = problem.Curve(problem.Guess());
      std::vector<planning::ObstaclePair> pairs;
      for (const int point : {5, 8, 11}) {
        const Eigen::Vector3d v = Eigen::Vector3d(Draw(0.3), 1.0, Draw(0.3)).normalized();
        pairs.push_back({point, guess.control_points().col(point) + 0.2 * v, v});
      }
      problem.SetPairs(pairs);
      bench->Run({problem.view(), problem.Guess(), {}}, 0, i);
    }
  }

  double Draw(double size) { return std::uniform_real_distribution(-size, size)(engine_); }

  const solvers::BackendRegistry backends_ = solvers::StandardBackends();
  const planning::TermRegistry terms_ = planning::StandardTerms();
  StraightPad pad_;
  std::mt19937_64 engine_{7};
};

TEST_F(Bench, EveryBackendFindsTheOneOptimumOfTheConvexProblem) {
  SolverBench bench({.repeats = 1}, backends_, terms_);
  Solve(&bench, 2);
  ASSERT_EQ(bench.result().problems.size(), 2U);
  for (const ProblemRow& row : bench.result().problems) {
    EXPECT_EQ(row.points, 19);
    EXPECT_EQ(row.pairs, 3);
    EXPECT_NEAR(row.duration_s, 6.0, 1e-9);
    EXPECT_FALSE(row.free_arrival || row.hard_limits || row.explicit_endpoint || row.standing);
    EXPECT_GT(row.start_gap, 1e-4);
  }
  for (const BackendSummary& s : Summarise(bench.result())) {
    if (s.backend == "nlopt-ccsaq" || s.backend == "ipopt-lm") continue;
    EXPECT_EQ(s.solved, 2) << s.backend;
    EXPECT_EQ(s.agreeing, s.reported_success) << s.backend;
    EXPECT_LE(*s.tight_gap.max, 1e-6) << s.backend;
    ASSERT_TRUE(s.shares) << s.backend;
    EXPECT_NEAR(s.shares->evaluation + s.shares->whitening + s.shares->native + s.shares->adapter,
                1.0, 1e-9);
  }
}

TEST_F(Bench, TellsFormulationsApart) {
  planning::LandingProblemOptions options;
  options.arrival = planning::ArrivalMode::kFree;
  options.limits_mode = planning::LimitsMode::kHard;
  SolverBench bench({.backends = {"banded", "ceres"}, .repeats = 1}, backends_, terms_);
  Solve(&bench, 1, options);
  EXPECT_EQ(bench.result().backends, std::vector<std::string>{"banded"});
  const ProblemRow& row = bench.result().problems.at(0);
  EXPECT_TRUE(row.free_arrival && row.hard_limits && !row.explicit_endpoint);
  EXPECT_LE(Summarise(bench.result())[0].violation_max, 1e-6);
  // Another structure in the same set; the refusal is told once.
  Solve(&bench, 1, options);
  options.endpoint = planning::EndpointMode::kExplicit;
  Solve(&bench, 1, options);
  EXPECT_TRUE(bench.result().problems.at(2).explicit_endpoint);
  ASSERT_EQ(bench.result().refusals.size(), 1U);
  EXPECT_THAT(bench.result().refusals[0].reason,
              HasSubstr("ceres takes no inequality constraints"));
}

TEST_F(Bench, AStartWithinTheGapIsNotTimed) {
  SolverBench bench({.backends = {"banded"}, .gap = 1.0, .repeats = 2}, backends_, terms_);
  Solve(&bench, 1);
  planning::LandingProblem problem(16, {});
  planning::SplineState start;
  start.p = {0.0, 0.0, 1.5};
  problem.SetBoundary(start, 0.0, pad_, {0.0, 0.3, 0.3, -1.0e3});
  problem.SetDuration(12.0);
  auto backend = solvers::MakeBackend(backends_, "banded");
  backend->Prepare(problem.view());
  solvers::SolverResult best;
  backend->Solve(problem.view(), problem.Guess(), {}, &best);
  bench.Run({problem.view(), best.x, {}}, 0, 1);
  const BenchResult& result = bench.result();
  EXPECT_TRUE(result.problems.back().standing);
  EXPECT_NEAR(result.problems.back().start_gap, 0.0, 1e-6);
  EXPECT_EQ(TimedProblems(result), Summarise(result)[0].problems);
  for (const SolveRow& row : result.solves) {
    EXPECT_TRUE(row.problem == 0 || row.phase == SolvePhase::kTight);
  }
}

TEST_F(Bench, WhatABackendSaysOfItselfCountsForNothing) {
  solvers::BackendRegistry registry = backends_;
  registry.push_back({"liar", "", [] { return std::make_unique<LyingSolver>(); }});
  SolverBench bench({.backends = {"banded", "liar"}, .repeats = 1}, registry, terms_);
  Solve(&bench, 2);
  const std::vector<BackendSummary> summaries = Summarise(bench.result());
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_EQ(summaries[0].solved, 2);
  const BackendSummary& liar = summaries[1];
  EXPECT_EQ(liar.solved, 0);
  EXPECT_EQ(liar.reported_success, 0) << "the base class looks at the point itself";
  EXPECT_EQ(liar.agreeing, 0);
  EXPECT_EQ(*liar.cpu_ms.median, kInfinity);
  CompareResult result;
  static_cast<BenchResult&>(result) = bench.result();
  result.flights = {"by hand"};
  EXPECT_TRUE(CompareJson({}, result, {})["backends"]["liar"]["time_ms"]["median"].is_null());
  EXPECT_THAT(CompareText({}, result), HasSubstr("fail"));
}

TEST_F(Bench, ASlowBackendSitsOutAndARefereeStillHelps) {
  const bool ipopt = std::any_of(backends_.begin(), backends_.end(),
                                 [](const auto& e) { return e.name == "ipopt"; });
  SolverBench bench({.backends = {"banded", "ceres"}, .repeats = 1, .backend_seconds = 1e-9},
                    backends_, terms_);
  Solve(&bench, 3);
  const BenchResult& result = bench.result();
  ASSERT_EQ(result.problems.size(), 3U);
  EXPECT_EQ(result.problems[0].reference_solves, 2 + ipopt);
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(result.problems[i].reference_solves, 1 + ipopt);
    EXPECT_TRUE(std::isfinite(result.problems[i].reference_cost));
  }
  for (const SolveRow& row : result.solves) EXPECT_EQ(row.problem, 0);
  ASSERT_EQ(result.refusals.size(), 2U);
  EXPECT_THAT(result.refusals[0].reason, HasSubstr("is skipped after 1 problems"));
  CompareResult told;
  static_cast<BenchResult&>(told) = result;
  told.flights = {"by hand"};
  EXPECT_FALSE(CompareJson({}, told, {})["backends"]["ceres"]["ran_all"].get<bool>());
  EXPECT_THAT(CompareText({}, told), HasSubstr("1 of 1 run, of 3"));
  for (const char* heading :
       {"reached: ", "iter, eval: ", "tight solves: ", "agree: ", "eval/whiten/native/adapter: "}) {
    EXPECT_THAT(CompareText({}, told), HasSubstr(heading));
  }
}

TEST_F(Bench, TurnsAreRandomAndRepeat) {
  const auto order = [&] {
    engine_.seed(7);
    SolverBench bench({.backends = {"banded", "ceres", "nlopt-lbfgs"}, .repeats = 12}, backends_,
                      terms_);
    Solve(&bench, 1);
    std::vector<std::string> names;
    for (const SolveRow& row : bench.result().solves) {
      if (row.phase == SolvePhase::kGap) names.push_back(row.backend);
    }
    return names;
  };
  const std::vector<std::string> names = order();
  ASSERT_EQ(names.size(), 36U);
  EXPECT_EQ(names, order());
  std::set<std::string> before_ceres;  // within one turn
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == "ceres") before_ceres.insert(i % 3 == 0 ? "nobody" : names[i - 1]);
  }
  EXPECT_EQ(before_ceres.size(), 3U);
}

TEST_F(Bench, RefusesUnknownEmptyAndDoubleNames) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"newton"}, {"banded", "banded"}, {""}}) {
    EXPECT_THROW(SolverBench({.backends = names}, backends_, terms_), BadInput);
  }
}

TEST_F(Bench, UnderADeadlineTheBestFeasiblePointComesBack) {
  SolverBench bench({.backends = {"banded", "nlopt-lbfgs"}, .repeats = 1, .deadline_ms = 0.02},
                    backends_, terms_);
  Solve(&bench, 2);
  for (const BackendSummary& s : Summarise(bench.result())) {
    ASSERT_TRUE(s.deadline);
    EXPECT_EQ(s.deadline->solves, 2);
    EXPECT_EQ(s.deadline->best_returned, 2) << s.backend;
  }
}

// Rows made by hand: of each size three problems with a reference, and one without.
BenchResult MadeUp() {
  BenchResult result;
  result.backends = {"a"};
  for (const int points : {10, 20, 40}) {
    for (int problem = 0; problem < 4; ++problem) {
      ProblemRow row;
      row.points = points;
      row.reference_cost = problem == 3 ? std::nan("") : 1.0;
      SolveRow solve;
      solve.problem = static_cast<int>(result.problems.size());
      result.problems.push_back(row);
      solve.backend = "a";
      solve.status = solvers::SolveStatus::kConverged;
      solve.phase = SolvePhase::kTight;
      solve.iterations = 10;
      solve.cpu_ms = problem == 3 ? 1.0 : 1e-3 * points * points;  // slope 2
      solve.max_violation = problem == 3 ? 1.0 : 0.0;
      solve.gap = problem == 2 ? 0.5 : 1e-9;
      result.solves.push_back(solve);
      solve.phase = SolvePhase::kGap;
      for (int repeat = 0; repeat < 3; ++repeat) {
        solve.repeat = repeat;
        solve.reached = problem != 2 || repeat == 0;
        solve.cpu_ms = 1.0 + problem + 10.0 * (repeat == 2);  // one repeat was disturbed
        result.solves.push_back(solve);
      }
    }
  }
  return result;
}

TEST(CompareSummary, FailuresAreInfiniteAndTheMedianRepeatCounts) {
  const BackendSummary s = Summarise(MadeUp())[0];
  EXPECT_EQ(s.problems, 9);
  EXPECT_EQ(s.solved, 6);
  EXPECT_DOUBLE_EQ(*s.cpu_ms.median, 2.0);  // of 1, 2, infinite, each three times
  EXPECT_EQ(*s.cpu_ms.p95, kInfinity);
  EXPECT_EQ(*s.cpu_ms.max, kInfinity);
  EXPECT_EQ(s.reported_success, 12) << "with those where no backend found a feasible point";
  EXPECT_EQ(s.agreeing, 6);
  EXPECT_EQ(TimedProblems(MadeUp()), 9);
}

TEST(CompareSummary, TimePerIterationIsOfSizesThatAreThereOften) {
  BenchResult result = MadeUp();
  EXPECT_TRUE(TimePerIteration(result, "a").empty()) << "three problems of each size";
  for (ProblemRow& row : result.problems) row.points = 20;
  EXPECT_NEAR(TimePerIteration(result, "a").at(20), 0.04, 1e-12);
  EXPECT_TRUE(TimePerIteration(result, "b").empty());
}

}  // namespace
}  // namespace touchdown::evaluation
