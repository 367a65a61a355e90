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
        Flown{
            "straight_turn",
            {},
            {{"clearance", {0.38414, 0.4163, 0.4131, 0.42346, 0.41643, 0.38922}},
             {"rebinds a step", {0.45055, 0.46067, 0.47826, 0.47253, 0.43333, 0.46154}},
             {"solves a step", {1.2088, 1.1685, 1.2065, 1.1978, 1.1333, 1.2308}},
             {"time to land", {7.2, 6.964, 7.302, 7.208, 7.066, 7.166}},
             {"touchdown error", {0.0094641, 0.0099777, 0.010001, 0.0095169, 0.0098254, 0.010093}},
             {"tracking", {0.02016, 0.017662, 0.01982, 0.021161, 0.011458, 0.020014}}}},
        Flown{"straight_turn",
              {"descent=vertical"},
              {{"clearance", {0.36251, 0.35779, 0.32562, 0.41816, 0.43956, 0.32081}},
               {"rebinds a step", {0.56911, 0.58779, 0.63309, 0.57812, 0.61538, 0.57851}},
               {"solves a step", {1.1138, 1.1832, 1.2158, 1.1016, 1.1538, 1.2066}},
               {"time to land", {11.95, 12.74, 13.52, 12.4, 13.95, 11.74}},
               {"touchdown error",
                {0.00044769, 0.00043194, 0.0063827, 0.00087596, 0.0010723, 0.00075733}},
               {"tracking", {0.023113, 0.0082209, 0.0078504, 0.013789, 0.0058035, 0.037823}}}},
        Flown{"circle",
              {"wind.mean=7", "wind.max=11"},
              {{"clearance", {0.37456, 0.31515, 0.41694, 0.37909, 0.39929, 0.37338}},
               {"rebinds a step", {0.40659, 0.42529, 0.41111, 0.5102, 0.43617, 0.64762}},
               {"solves a step", {1.1319, 1.1379, 1.1111, 1.2347, 1.234, 1.419}},
               {"time to land", {7.188, 6.92, 7.094, 7.974, 7.616, 8.714}},
               {"touchdown error", {0.038411, 0.024792, 0.025484, 0.071703, 0.06447, 0.013617}},
               {"tracking", {0.07754, 0.042877, 0.053799, 0.067275, 0.05035, 0.059223}}}},
        Flown{"forest",
              {},
              {{"clearance", {0.33718, 0.30498, 0.37312, 0.33292, 0.33568, 0.38473}},
               {"rebinds a step", {0.41892, 0.59231, 0.55, 0.54918, 0.30508, 0.51064}},
               {"solves a step", {1.1216, 1.1231, 1.3625, 1.082, 1.1864, 1.1489}},
               {"time to land", {5.536, 11.178, 6.054, 10.254, 4.358, 7.546}},
               {"touchdown error",
                {0.0065837, 0.0095768, 0.0069151, 0.0078694, 0.0074776, 0.0069979}},
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
