// SPDX-License-Identifier: BSD-3-Clause
// The problems repeat, the judge stands outside, failures stay failures.
#include "touchdown/evaluation/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/compare_report.h"
#include "touchdown/evaluation/compare_summary.h"

namespace touchdown::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CompareOptions Tiny() {
  CompareOptions options;
  options.cases.problem.limits = {4.0, 6.0};
  options.cases.forest = std::string("B");
  options.problems = 2;
  options.points = {14};
  options.repeats = 1;
  return options;
}

CompareResult Compared(const CompareOptions& options, const solvers::BackendRegistry& registry) {
  return RunCompare(options, registry, [](int, int) {});
}

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

TEST(LandingCase, IsClearAtTheReferenceSizes) {
  for (const bool warm : {false, true}) {
    CompareOptions options = Tiny();
    options.cases.warm = warm;
    for (const int points : CaseMaker::kReferencePoints) {
      CaseMaker maker(options.cases, points);
      for (int index = 0; index < 6; ++index) {
        const LandingCase made = maker.Make(index);
        EXPECT_TRUE(made.clear) << warm << " " << points << " " << index;
        EXPECT_EQ(made.warm.has_value(), warm);
      }
    }
  }
}

TEST(LandingCase, RepeatsAndIsOneSceneForEverySize) {
  const CompareOptions options = Tiny();
  CaseMaker maker(options.cases, 14);
  CaseMaker again(options.cases, 14);
  CaseMaker larger(options.cases, 40);
  CaseMaker smallest(options.cases, 9);
  int bound = 0;
  for (int index = 0; index < 4; ++index) {
    const LandingCase a = maker.Make(index);
    const LandingCase b = again.Make(index);
    EXPECT_EQ(a.start.p, b.start.p);
    EXPECT_EQ(a.duration, b.duration);
    ASSERT_EQ(a.pairs.size(), b.pairs.size());
    for (std::size_t i = 0; i < a.pairs.size(); ++i) EXPECT_EQ(a.pairs[i].p, b.pairs[i].p);
    bound += static_cast<int>(a.pairs.size());
    for (CaseMaker* other : {&larger, &smallest}) {
      const LandingCase c = other->Make(index);
      EXPECT_EQ(a.draws, c.draws);
      EXPECT_EQ(a.start.p, c.start.p);
      EXPECT_EQ(a.duration, c.duration);
      EXPECT_EQ(a.pad->At(1.0).p_WP, c.pad->At(1.0).p_WP);
    }
    EXPECT_GE(a.draws - 1, a.not_clear + a.unsolved);
    const Eigen::Vector3d way = a.pad->At(a.duration).p_WP - a.start.p;
    EXPECT_LE(way.head<2>().lpNorm<Eigen::Infinity>(), 12.0) << "the goal is off the map";
    EXPECT_LE(a.start.v.norm(), 0.7 * 4.0);
    EXPECT_GE(a.pad_speed, 0.5);
    EXPECT_LE(a.pad_speed, 2.0);
    EXPECT_LE(std::abs(a.pad_rate), 0.2);
    EXPECT_LT(a.duration, 12.0);
  }
  EXPECT_GT(bound, 0) << "no forest was in the way";
  // Order does not matter.
  EXPECT_EQ(maker.Make(0).start.p, again.Make(0).start.p);
}

TEST(LandingCase, AWarmStartMeetsItsEndsAndIsNearTheOptimum) {
  CompareOptions options = Tiny();
  options.cases.warm = true;
  CaseMaker maker(options.cases, 20);
  planning::LandingProblem problem(17, options.cases.problem);
  const LandingCase made = maker.Make(1);
  made.Apply(&problem);
  EXPECT_NEAR(made.t0, 0.1, 1e-12);
  ASSERT_TRUE(made.warm);
  const planning::UniformBspline curve = problem.Curve(made.StartPoint(problem));
  EXPECT_LT((curve.AtKnot(0).p - made.start.p).norm(), 1e-9);
  EXPECT_LT((curve.control_points() - made.warm->control_points()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LandingCase, DoesNotHangOnWhatIsSolvedLater) {
  CompareOptions options = Tiny();
  options.cases.warm = true;
  CaseOptions other = options.cases;
  other.problem.arrival = planning::ArrivalMode::kFree;
  other.problem.limits_mode = planning::LimitsMode::kHard;
  other.problem.endpoint = planning::EndpointMode::kExplicit;
  CaseMaker one(options.cases, 20);
  CaseMaker two(other, 20);
  int bound = 0;
  for (int index = 0; index < 4; ++index) {
    const LandingCase a = one.Make(index);
    const LandingCase b = two.Make(index);
    EXPECT_EQ(a.start.p, b.start.p);
    ASSERT_EQ(a.pairs.size(), b.pairs.size());
    for (std::size_t i = 0; i < a.pairs.size(); ++i) EXPECT_EQ(a.pairs[i].p, b.pairs[i].p);
    EXPECT_EQ(a.warm->control_points(), b.warm->control_points());
    bound += static_cast<int>(a.pairs.size());
  }
  EXPECT_GT(bound, 0) << "no forest was in the way";
}

TEST(LandingCase, RefusesUnknownForests) {
  CaseOptions options;
  options.forest = "jungle";
  EXPECT_THROW(CaseMaker(options, 20), std::invalid_argument);
}

TEST(Compare, EveryBackendFindsTheOneOptimumOfTheConvexProblem) {
  const CompareOptions options = Tiny();
  const CompareResult result = Compared(options, solvers::StandardBackends());
  ASSERT_EQ(result.problems.size(), 2U);
  for (const BackendSummary& s : Summarise(result, 14)) {
    if (s.backend == "nlopt-ccsaq" || s.backend == "ipopt-lm") continue;
    EXPECT_EQ(s.solved, 2) << s.backend;
    EXPECT_EQ(s.agreeing, s.reported_success) << s.backend;
    EXPECT_LE(*s.tight_gap.max, 1e-6) << s.backend;
    EXPECT_LE(s.end_position_max, 1e-9) << s.backend;
    EXPECT_LE(s.end_velocity_max, 1e-9) << s.backend;
    ASSERT_TRUE(s.shares) << s.backend;
    EXPECT_NEAR(s.shares->evaluation + s.shares->whitening + s.shares->native + s.shares->adapter,
                1.0, 1e-9);
  }
}

TEST(Compare, WhatABackendSaysOfItselfCountsForNothing) {
  CompareOptions options = Tiny();
  solvers::BackendRegistry registry = solvers::StandardBackends();
  registry.push_back({"liar", "", [] { return std::make_unique<LyingSolver>(); }});
  options.backends = {"banded", "liar"};
  const CompareResult result = Compared(options, registry);
  const std::vector<BackendSummary> summaries = Summarise(result, 0);
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_EQ(summaries[0].solved, 2);
  const BackendSummary& liar = summaries[1];
  EXPECT_EQ(liar.solved, 0);
  EXPECT_EQ(liar.reported_success, 0) << "the base class looks at the point itself";
  EXPECT_EQ(liar.agreeing, 0);
  EXPECT_EQ(*liar.cpu_ms.median, kInfinity);
  EXPECT_TRUE(CompareJson(options, result, {})["backends"]["liar"]["time_ms"]["median"].is_null());
  EXPECT_THAT(CompareText(options, result), HasSubstr("fail"));
}

TEST(Compare, RefusalsAreListedWithTheirSentence) {
  CompareOptions options = Tiny();
  options.problems = 1;
  options.backends = {"banded", "ceres"};
  options.cases.problem.limits_mode = planning::LimitsMode::kHard;
  const CompareResult result = Compared(options, solvers::StandardBackends());
  EXPECT_EQ(result.backends, std::vector<std::string>{"banded"});
  ASSERT_EQ(result.refusals.size(), 1U);
  EXPECT_THAT(result.refusals[0].reason, HasSubstr("ceres takes no inequality constraints"));
  EXPECT_LE(Summarise(result, 0)[0].violation_max, 1e-6);
  options.backends = {"ceres"};
  EXPECT_THROW(Compared(options, solvers::StandardBackends()), BadInput);
  options.backends = {"newton"};
  EXPECT_THROW(Compared(options, solvers::StandardBackends()), BadInput);
}

TEST(Compare, ASlowBackendSitsOut) {
  CompareOptions options = Tiny();
  options.backends = {"ceres"};
  options.points = {14, 16};
  options.backend_seconds = 1e-9;
  const CompareResult result = Compared(options, solvers::StandardBackends());
  EXPECT_EQ(Summarise(result, 14)[0].problems, 1);
  EXPECT_EQ(Summarise(result, 16)[0].problems, 0);
  ASSERT_EQ(result.refusals.size(), 2U);
  EXPECT_THAT(result.refusals[0].reason, HasSubstr("stopped after 1 of 2 problems"));
  EXPECT_THAT(result.refusals[1].reason, HasSubstr("sits out"));
  // Its figures stand under the size, not beside those of backends that ran all problems.
  const nlohmann::ordered_json json = CompareJson(options, result, {});
  EXPECT_TRUE(json["backends"].empty());
  EXPECT_EQ(json["by_points"]["14"]["ceres"]["problems"], 1);
}

TEST(Compare, ASlowRefereeStillHelpsToFindTheReference) {
  CompareOptions options = Tiny();
  options.backends = {"banded", "ceres"};
  options.points = {14, 16};
  options.backend_seconds = 1e-9;
  const solvers::BackendRegistry registry = solvers::StandardBackends();
  const bool ipopt = std::any_of(registry.begin(), registry.end(),
                                 [](const auto& e) { return e.name == "ipopt"; });
  const CompareResult result = Compared(options, registry);
  ASSERT_EQ(result.problems.size(), 4U);
  EXPECT_EQ(result.problems[0].reference_solves, 2 + ipopt);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(result.problems[i].reference_solves, 1 + ipopt);
    EXPECT_TRUE(std::isfinite(result.problems[i].reference_cost));
  }
  for (const SolveRow& row : result.solves) {
    EXPECT_EQ(row.points, 14);
    EXPECT_EQ(row.problem, 0);
  }
}

TEST(Compare, TurnsAreRandomAndRepeat) {
  CompareOptions options = Tiny();
  options.backends = {"banded", "ceres", "nlopt-lbfgs"};
  options.problems = 1;
  options.repeats = 12;
  const auto order = [&options] {
    std::vector<std::string> names;
    for (const SolveRow& row : Compared(options, solvers::StandardBackends()).solves) {
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

TEST(Compare, RefusesEmptyAndDoubleNames) {
  CompareOptions options = Tiny();
  options.backends = {"banded", "banded"};
  EXPECT_THROW(Compared(options, solvers::StandardBackends()), BadInput);
  options.backends.back().clear();
  EXPECT_THROW(Compared(options, solvers::StandardBackends()), BadInput);
}

TEST(Compare, UnderADeadlineTheBestFeasiblePointComesBack) {
  CompareOptions options = Tiny();
  options.backends = {"banded", "nlopt-lbfgs"};
  options.deadline_ms = 0.02;
  for (const BackendSummary& s : Summarise(Compared(options, solvers::StandardBackends()), 0)) {
    ASSERT_TRUE(s.deadline);
    EXPECT_EQ(s.deadline->solves, 2);
    EXPECT_EQ(s.deadline->best_returned, 2) << s.backend;
  }
}

// Rows made by hand.
CompareResult MadeUp() {
  CompareResult result;
  result.backends = {"a"};
  for (const int points : {10, 20, 40}) {
    for (int problem = 0; problem < 4; ++problem) {
      ProblemRow row;
      row.points = points;
      row.made.index = problem;
      row.reference_cost = problem == 3 ? std::nan("") : 1.0;  // the last has no reference
      result.problems.push_back(row);
      SolveRow solve;
      solve.points = points;
      solve.problem = problem;
      solve.backend = "a";
      solve.status = solvers::SolveStatus::kConverged;
      solve.phase = SolvePhase::kTight;
      solve.iterations = 10;
      solve.cpu_ms = 1e-3 * points * points;  // slope 2
      if (problem == 3) solve.cpu_ms = 1.0;
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
  const BackendSummary s = Summarise(MadeUp(), 10)[0];
  EXPECT_EQ(s.problems, 3);
  EXPECT_EQ(s.solved, 2);
  EXPECT_DOUBLE_EQ(*s.cpu_ms.median, 2.0);  // of 1, 2, infinite
  EXPECT_EQ(*s.cpu_ms.p95, kInfinity);
  EXPECT_EQ(*s.cpu_ms.max, kInfinity);
  EXPECT_EQ(s.reported_success, 4) << "with the one where nobody found a feasible point";
  EXPECT_EQ(s.agreeing, 2);
  EXPECT_EQ(RatedProblems(MadeUp(), 10), 3);
  EXPECT_EQ(RatedProblems(MadeUp(), 0), 9);
  EXPECT_EQ(Summarise(MadeUp(), 0)[0].problems, 9);
}

TEST(CompareSummary, SlopeOfATimeThatIsQuadratic) {
  EXPECT_NEAR(*ScalingSlope(MadeUp(), "a"), 2.0, 1e-9);
  EXPECT_FALSE(ScalingSlope(MadeUp(), "b"));
}

}  // namespace
}  // namespace touchdown::evaluation
