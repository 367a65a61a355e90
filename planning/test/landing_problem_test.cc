// SPDX-License-Identifier: BSD-3-Clause
// The landing problem as a whole: both ends met exactly at every point the solver can reach, and
// the one optimum of the convex problem from any start.

#include <gtest/gtest.h>

#include "touchdown/planning/duration_guess.h"
#include "touchdown/planning/landing_problem.h"
#include "touchdown/planning/test/planning_fixtures.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {
namespace {

constexpr double kExact = 1e-9;

LandingProblemOptions Options(ArrivalMode arrival, bool free_end_acceleration = true) {
  LandingProblemOptions options;
  options.arrival = arrival;
  options.free_end_acceleration = free_end_acceleration;
  return options;
}

TEST(LandingProblem, BothEndsAreMetExactlyAtAnyPoint) {
  Draw draw(3);
  for (int trial = 0; trial < 400; ++trial) {
    const ArrivalMode arrival = trial % 2 ? ArrivalMode::kFree : ArrivalMode::kFixed;
    const bool free_end = trial % 4 < 2;
    const int segments = 6 + trial % 30;
    LandingProblem problem(segments, Options(arrival, free_end));
    const ArcPad pad = draw.Pad();
    const SplineState start = draw.State(10.0, 3.0, 4.0);
    const double t0 = draw.Uniform(0.0, 100.0);
    const EndpointTarget target{t0, draw.Uniform(0.0, 3.0), draw.Uniform(0.0, 0.5), 0.2};
    problem.SetBoundary(start, t0, pad, target);
    problem.SetDuration(draw.Uniform(0.6, 12.0));
    Eigen::VectorXd y = problem.Guess();
    for (int i = 0; i < y.size(); ++i) y[i] += draw.Uniform(-0.2, 0.2) * (i + 1 < y.size());

    const UniformBspline curve = problem.Curve(y);
    const SplineState first = curve.AtKnot(0), last = curve.AtKnot(segments);
    const SplineState wanted = EndStateAt(pad, target, curve.t_end()).state;
    EXPECT_LT((first.p - start.p).norm(), kExact);
    EXPECT_LT((first.v - start.v).norm(), kExact);
    EXPECT_LT((first.a - start.a).norm(), 1e-7);
    EXPECT_LT((last.p - wanted.p).norm(), kExact);
    EXPECT_LT((last.v - wanted.v).norm(), kExact);
    if (!free_end) {
      EXPECT_LT((last.a - wanted.a).norm(), 1e-7);
    }
  }
}

TEST(LandingProblem, FixedArrivalIsConvexAndHasOneOptimum) {
  Draw draw(5);
  const solvers::BackendRegistry backends = solvers::StandardBackends();
  for (int trial = 0; trial < 10; ++trial) {
    LandingProblem problem(20, Options(ArrivalMode::kFixed));
    EXPECT_TRUE(problem.view().problem().convex());
    const ArcPad pad = draw.Pad();
    const SplineState start = draw.State(4.0, 1.0, 1.0);
    const EndpointTarget target{0.0, 1.5, 0.0, 0.5};
    problem.SetBoundary(start, 0.0, pad, target);
    problem.SetDuration(1.2 * GuessDuration(start, 0.0, pad, target, {}, 1.0));
    const UniformBspline guess = problem.Curve(problem.Guess());
    std::vector<ObstaclePair> pairs;
    for (int i = 6; i < 16; i += 3) {
      pairs.push_back(
          {i, guess.control_points().col(i) + draw.Vector(0.3), draw.Vector(1.0).normalized()});
    }
    problem.SetPairs(pairs);

    auto backend = solvers::MakeBackend(backends, "ceres");
    backend->options().Set("function_tolerance", 1e-14);
    backend->Prepare(problem.view());
    solvers::SolverResult a, b;
    backend->Solve(problem.view(), problem.Guess(), {}, &a);
    Eigen::VectorXd far = problem.Guess();
    for (int i = 0; i < far.size(); ++i) far[i] = draw.Uniform(-1.0, 1.0);
    backend->Solve(problem.view(), far, {.max_iterations = 300}, &b);
    ASSERT_TRUE(a.usable() && b.usable()) << a.message << b.message;
    EXPECT_NEAR(a.cost, b.cost, 1e-6 * a.cost);
    EXPECT_LT((a.x - b.x).cwiseAbs().maxCoeff(), 1e-2);
  }
}

TEST(LandingProblem, FreeArrivalBeatsTheGuessAndStaysInItsBounds) {
  Draw draw(7);
  const solvers::BackendRegistry backends = solvers::StandardBackends();
  for (int trial = 0; trial < 10; ++trial) {
    const LandingProblemOptions options = Options(ArrivalMode::kFree);
    LandingProblem problem(20, options);
    const ArcPad pad = draw.Pad();
    const SplineState start = draw.State(4.0, 1.0, 1.0);
    const EndpointTarget target{0.0, 1.5, 0.0, 0.5};
    problem.SetBoundary(start, 0.0, pad, target);
    problem.SetDuration(GuessDuration(start, 0.0, pad, target, options.limits, 1.0));
    auto backend = solvers::MakeBackend(backends, "ceres");
    backend->Prepare(problem.view());
    solvers::SolverResult result;
    solvers::ViewEvaluation at_guess;
    problem.view().Resize(&at_guess);
    ASSERT_TRUE(problem.view().Evaluate(problem.Guess().data(), {}, {}, &at_guess));
    backend->Solve(problem.view(), problem.Guess(), {}, &result);
    ASSERT_TRUE(result.usable()) << result.message;
    EXPECT_LE(result.cost, at_guess.full.value);
    const double T = problem.Curve(result.x).duration();
    EXPECT_GE(T, options.min_duration - 1e-9);
    EXPECT_LE(T, options.max_duration + 1e-9);
  }
}

TEST(LandingProblem, RefusesTooFewSegments) {
  EXPECT_THROW(LandingProblem(5, {}), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
