// SPDX-License-Identifier: BSD-3-Clause
// The time of one evaluation of a landing problem, all derivatives included, by number of control
// points. Solve times are multiples of it. Also the boundary lift's share in a free arrival.

#include <benchmark/benchmark.h>

#include "planning/problem/random_context.h"
#include "touchdown/planning/problem/landing_problem.h"

namespace touchdown::planning {
namespace {

void Evaluate(benchmark::State& state, ArrivalMode arrival, LimitsMode limits) {
  const int segments = static_cast<int>(state.range(0)) - 3;
  std::mt19937_64 random(1);
  LandingProblemOptions options;
  options.arrival = arrival;
  options.limits_mode = limits;
  LandingProblem problem(segments, options);
  const RandomContext context(segments, 8, 0, random);
  const LandingContext& c = context.get();
  problem.SetBoundary(c.start, c.t0, *c.pad, c.target);
  problem.SetDuration(segments * c.interval);
  problem.SetPairs(c.pairs);
  const solvers::View& view = problem.view();
  solvers::ViewEvaluation evaluation;
  view.Resize(&evaluation);
  evaluation.HoldParameters();
  const Eigen::VectorXd y = problem.Guess();
  const std::vector<double> multipliers(static_cast<std::size_t>(6 * segments), 1.0);
  const std::vector<solvers::RowWeights> rows(
      static_cast<std::size_t>(view.problem().num_terms()),
      {.multiplier = multipliers.data(), .weight = multipliers.data()});
  for (auto _ : state) {
    view.Evaluate(y.data(), {.gradient = true, .hessian = true}, {.rows = rows.data()},
                  &evaluation);
    benchmark::DoNotOptimize(evaluation.full.value);
  }
}

void Lift(benchmark::State& state) {
  const int segments = static_cast<int>(state.range(0)) - 3;
  std::mt19937_64 random(1);
  const RandomContext context(segments, 0, 0, random);
  const LandingContext& c = context.get();
  BoundaryLift lift(segments, true);
  lift.Set(c.start, c.t0, *c.pad, c.target);
  std::vector<double> l(static_cast<std::size_t>(3 * (segments + 3))), dl = l, d2l = l;
  for (auto _ : state) {
    lift.At(c.interval, l.data(), dl.data(), d2l.data());
    benchmark::DoNotOptimize(l.data());
    benchmark::ClobberMemory();
  }
}

BENCHMARK_CAPTURE(Evaluate, soft_fixed, ArrivalMode::kFixed, LimitsMode::kSoft)->Arg(20)->Arg(40);
BENCHMARK_CAPTURE(Evaluate, soft_free, ArrivalMode::kFree, LimitsMode::kSoft)->Arg(20)->Arg(40);
BENCHMARK_CAPTURE(Evaluate, hard_fixed, ArrivalMode::kFixed, LimitsMode::kHard)->Arg(20)->Arg(40);
BENCHMARK_CAPTURE(Evaluate, hard_free, ArrivalMode::kFree, LimitsMode::kHard)->Arg(20)->Arg(40);
BENCHMARK(Lift)->Arg(20)->Arg(40);

}  // namespace
}  // namespace touchdown::planning
