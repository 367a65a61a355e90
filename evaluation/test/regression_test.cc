// SPDX-License-Identifier: BSD-3-Clause
// Results of flights, within bands that are no wider than twice the spread over seeds.
// TOUCHDOWN_BANDS=print prints the values for the tables. A change that moves one says why.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/base/statistics.h"
#include "evaluation/compare/solver_bench.h"
#include "evaluation/flight/closed_loop.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

constexpr int kSeeds = 6;

/// By figure, the measured value of each seed.
using Samples = std::map<std::string, std::vector<double>>;

double Median(const std::vector<double>& values) { return *Quantile(values, 0.5); }

/// Each value lies in the spread over the seeds and half of it on either side. A common change of all seeds shows
/// sooner: the median of the seeds' changes is at most an eighth of the spread.
void ExpectInBands(const std::string& what, const Samples& samples, const Samples& before) {
  const char* asked = std::getenv("TOUCHDOWN_BANDS");
  if (asked != nullptr && std::string(asked) == "print") {
    for (const auto& [figure, values] : samples) {
      std::printf("%s: {\"%s\", {", what.c_str(), figure.c_str());
      for (const double value : values) std::printf("%.5g, ", value);
      std::printf("}},\n");
    }
  }
  for (const auto& [figure, then] : before) {
    ASSERT_TRUE(samples.contains(figure)) << what << ": nothing is measured as " << figure;
    const std::vector<double>& now = samples.at(figure);
    ASSERT_EQ(now.size(), then.size()) << what << ": " << figure;
    const auto [least, most] = std::minmax_element(then.begin(), then.end());
    const double spread = *most - *least;
    std::vector<double> changes;
    for (std::size_t seed = 0; seed < now.size(); ++seed) {
      EXPECT_GE(now[seed], *least - 0.5 * spread) << what << ": " << figure;
      EXPECT_LE(now[seed], *most + 0.5 * spread) << what << ": " << figure;
      changes.push_back(now[seed] - then[seed]);
    }
    EXPECT_NEAR(Median(changes), 0.0, 0.125 * spread) << what << ": " << figure;
  }
  EXPECT_EQ(samples.size(), before.size()) << what;
}

/// Tracking error of the vehicle, 95 % quantile [m].
double Tracking(const TrialRecord& record, double until) {
  std::vector<double> errors;
  for (const RecordSample& sample : record.samples) {
    if (sample.t < until) errors.push_back((sample.vehicle.p_WB - sample.reference.p_WB).norm());
  }
  return *Quantile(errors, 0.95);
}

struct Flown {
  std::string scenario;
  std::vector<std::string> set;
  Samples table;
};

void PrintTo(const Flown& flown, std::ostream* out) {
  *out << flown.scenario << (flown.set.empty() ? "" : " ")
       << (flown.set.empty() ? "" : flown.set[0]);
}

class Regression : public ::testing::TestWithParam<Flown> {};

TEST_P(Regression, FlightsStayInTheirBands) {
  const Flown& flown = GetParam();
  const Registries registries = StandardRegistries();
  const Scenario scenario = LoadScenario(FindScenario(flown.scenario), flown.set, registries);
  Samples samples;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, seed, registries, &record);
    ASSERT_TRUE(result.landed()) << seed << ": " << result.detail;
    int solves = 0, rebinds = 0;
    for (const RecordPlan& plan : record.plans) {
      solves += plan.result.solves;
      rebinds += plan.result.rebinds;
    }
    const auto steps = static_cast<double>(record.plans.size());
    samples["time to land"].push_back(result.touchdown->t);
    samples["touchdown error"].push_back(result.touchdown->error_m);
    samples["clearance"].push_back(*result.min_clearance_m);
    samples["tracking"].push_back(Tracking(record, result.touchdown->t));
    samples["solves a step"].push_back(solves / steps);
    samples["rebinds a step"].push_back(rebinds / steps);
  }
  ExpectInBands(flown.scenario, samples, flown.table);
}

INSTANTIATE_TEST_SUITE_P(
    Shipped, Regression,
    ::testing::Values(
        Flown{"straight_turn",
              {},
              {{"clearance", {0.38317, 0.4163, 0.4131, 0.42346, 0.41643, 0.38922}},
               {"rebinds a step", {0.45055, 0.46067, 0.47826, 0.47253, 0.43333, 0.46154}},
               {"solves a step", {1.2088, 1.1685, 1.2065, 1.1978, 1.1333, 1.2308}},
               {"time to land", {7.2, 6.964, 7.302, 7.208, 7.068, 7.166}},
               {"touchdown error", {0.0089291, 0.010044, 0.010105, 0.0096981, 0.0098379, 0.01004}},
               {"tracking", {0.02016, 0.017662, 0.01982, 0.021161, 0.011458, 0.020014}}}},
        Flown{"straight_turn",
              {"descent=vertical"},
              {{"clearance", {0.36338, 0.35778, 0.32562, 0.40252, 0.43956, 0.32081}},
               {"rebinds a step", {0.56911, 0.58779, 0.63309, 0.58268, 0.61538, 0.57851}},
               {"solves a step", {1.1138, 1.1832, 1.2158, 1.1024, 1.1538, 1.2066}},
               {"time to land", {11.96, 12.74, 13.518, 12.388, 13.948, 11.74}},
               {"touchdown error",
                {0.0015581, 0.00039968, 0.0060388, 0.00068873, 0.00099638, 0.0006474}},
               {"tracking", {0.023113, 0.0082278, 0.0078153, 0.013789, 0.0058035, 0.037823}}}},
        Flown{"circle",
              {"wind.mean=7", "wind.max=11"},
              {{"clearance", {0.39955, 0.32718, 0.42135, 0.40304, 0.38265, 0.33188}},
               {"rebinds a step", {0.42391, 0.42529, 0.43182, 0.57732, 0.44792, 0.41304}},
               {"solves a step", {1.1087, 1.1264, 1.125, 1.2577, 1.1354, 1.1304}},
               {"time to land", {7.332, 7.024, 6.97, 7.98, 7.87, 7.474}},
               {"touchdown error", {0.029236, 0.028352, 0.018985, 0.077276, 0.062719, 0.036604}},
               {"tracking", {0.077074, 0.04367, 0.052807, 0.07266, 0.054381, 0.073327}}}},
        Flown{"forest",
              {},
              {{"clearance", {0.33718, 0.30498, 0.37312, 0.33292, 0.33568, 0.38473}},
               {"rebinds a step", {0.41892, 0.59231, 0.55, 0.54918, 0.30508, 0.51064}},
               {"solves a step", {1.1216, 1.1231, 1.3625, 1.082, 1.1864, 1.1489}},
               {"time to land", {5.536, 11.178, 6.054, 10.254, 4.358, 7.546}},
               {"touchdown error",
                {0.0067736, 0.0094809, 0.0071555, 0.0080139, 0.0077907, 0.0070519}},
               {"tracking", {0.026504, 0.016554, 0.018337, 0.011781, 0.01138, 0.015823}}}}));

// Of the solves that a flight asks for, one in 12: evaluations until a point is within the gap that is flown.
TEST(RegressionOfBackends, EvaluationsToTheGap) {
  const Registries registries = StandardRegistries();
  const Scenario scenario = LoadScenario(FindScenario("straight_turn"), {}, registries);
  SolverBench bench({.backends = {"banded", "lbfgs", "ceres", "ceres-lbfgs", "nlopt-lbfgs",
                                  "nlopt-tnewton", "ipopt"},
                     .gap = 0.005,
                     .repeats = 1,
                     .shares = false,
                     .backend_seconds = 1e6},
                    registries.backends, registries.terms);
  Samples samples;
  std::size_t told = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Registries overheard = registries;
    int asked = 0;
    overheard.backends =
        solvers::Overheard(registries.backends, [&](const solvers::SolveRequest& solve) {
          if (asked++ % 12 == 0) bench.Run(solve, 0, asked);
        });
    RunTrial(scenario, seed, overheard);
    std::map<std::string, std::pair<double, int>> sums;
    const std::vector<SolveRow>& rows = bench.result().solves;
    for (; told < rows.size(); ++told) {
      const SolveRow& row = rows[told];
      if (row.phase != SolvePhase::kGap) continue;
      EXPECT_TRUE(row.reached) << row.backend << " on problem " << row.problem;
      sums[row.backend].first += row.evaluations;
      ++sums[row.backend].second;
    }
    for (const auto& [backend, sum] : sums) samples[backend].push_back(sum.first / sum.second);
  }
  const Samples table = {{"banded", {5.8, 6, 6.4, 4, 6, 5}},
                         {"ceres", {7.2, 9.3333, 9.8, 3.6667, 6.6, 5.5}},
                         {"ceres-lbfgs", {23.6, 13.167, 22.2, 8.8333, 14.6, 14.625}},
                         {"ipopt", {6, 7.3333, 7, 4.1667, 6.8, 4.875}},
                         {"lbfgs", {11.4, 7.8333, 12.2, 5, 10.6, 7.875}},
                         {"nlopt-lbfgs", {11.4, 10, 16.4, 8, 13, 11.375}},
                         {"nlopt-tnewton", {27, 17.333, 20.2, 11, 21.8, 17.875}}};
  ExpectInBands("evaluations", samples, table);
}

}  // namespace
}  // namespace touchdown::evaluation
