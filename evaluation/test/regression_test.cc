// SPDX-License-Identifier: BSD-3-Clause
// What flights come to, held in bands that are no wider than twice the spread over seeds: worse by a little is
// noticed, and so is better. TOUCHDOWN_BANDS=print prints what a table of bands is to hold; a change that moves
// one says why.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "touchdown/evaluation/closed_loop.h"
#include "touchdown/evaluation/solver_bench.h"
#include "touchdown/evaluation/statistics.h"

namespace touchdown::evaluation {
namespace {

constexpr int kSeeds = 6;

/// A figure over the seeds, as it was measured.
struct Measured {
  double least, median, most;
};
using Table = std::map<std::string, Measured>;
using Samples = std::map<std::string, std::vector<double>>;

Measured Of(const std::vector<double>& values) {
  return {*Quantile(values, 0.0), *Quantile(values, 0.5), *Quantile(values, 1.0)};
}

/// Each value lies in the spread and half of it on either side, and their median within half of it.
void ExpectInBands(const std::string& what, const Samples& samples, const Table& table) {
  const char* asked = std::getenv("TOUCHDOWN_BANDS");
  if (asked != nullptr && std::string(asked) == "print") {
    for (const auto& [figure, values] : samples) {
      const Measured now = Of(values);
      std::printf("%s: {\"%s\", {%.4g, %.4g, %.4g}},\n", what.c_str(), figure.c_str(), now.least,
                  now.median, now.most);
    }
  }
  for (const auto& [figure, values] : samples) {
    ASSERT_TRUE(table.contains(figure)) << what << ": " << figure;
    const Measured& before = table.at(figure);
    // Four digits are kept of what was measured.
    const double half = 0.5 * (before.most - before.least) + 1e-3 * std::abs(before.most);
    for (const double value : values) {
      EXPECT_GE(value, before.least - half) << what << ": " << figure;
      EXPECT_LE(value, before.most + half) << what << ": " << figure;
    }
    EXPECT_NEAR(Of(values).median, before.median, half) << what << ": " << figure;
  }
}

/// Largest distance but for the worst twentieth, of the vehicle from what it was told to fly [m].
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
  Table table;
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
    ::testing::Values(Flown{"straight_turn",
                            {},
                            {{"clearance", {0.3117, 0.3399, 0.4118}},
                             {"rebinds a step", {0.427, 0.4576, 0.5543}},
                             {"solves a step", {1.191, 1.219, 1.304}},
                             {"time to land", {6.944, 6.988, 7.296}},
                             {"touchdown error", {0.005148, 0.01164, 0.01265}},
                             {"tracking", {0.01531, 0.01803, 0.02222}}}},
                      Flown{"straight_turn",
                            {"descent=vertical"},
                            {{"clearance", {0.3032, 0.388, 0.4438}},
                             {"rebinds a step", {0.5781, 0.6356, 0.7244}},
                             {"solves a step", {1.102, 1.271, 1.394}},
                             {"time to land", {11.95, 12.27, 13.44}},
                             {"touchdown error", {0.0003656, 0.0005251, 0.006123}},
                             {"tracking", {0.008369, 0.01533, 0.02727}}}},
                      Flown{"circle",
                            {"wind.mean=7", "wind.max=11"},
                            {{"clearance", {0.3577, 0.3984, 0.4181}},
                             {"rebinds a step", {0.4066, 0.4767, 0.6355}},
                             {"solves a step", {1.111, 1.191, 1.415}},
                             {"time to land", {7.006, 7.418, 8.868}},
                             {"touchdown error", {0.01139, 0.03337, 0.07177}},
                             {"tracking", {0.04338, 0.05751, 0.07784}}}},
                      Flown{"forest",
                            {},
                            {{"clearance", {0.266, 0.3527, 0.4094}},
                             {"rebinds a step", {0.2586, 0.4174, 0.5528}},
                             {"solves a step", {1.085, 1.125, 1.2}},
                             {"time to land", {4.258, 6.412, 11.11}},
                             {"touchdown error", {0.006825, 0.008848, 0.01234}},
                             {"tracking", {0.01212, 0.01981, 0.05207}}}}));

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
        solvers::Overheard(registries.backends, [&](const solvers::AskedSolve& solve) {
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
  const Table table = {{"banded", {5.5, 6.1, 6.8}},           {"ceres", {6, 6.774, 9.4}},
                       {"ceres-lbfgs", {15.29, 18.58, 20.2}}, {"ipopt", {5.833, 6.414, 7.2}},
                       {"lbfgs", {8.667, 10.1, 11.17}},       {"nlopt-lbfgs", {10.67, 13, 14.6}},
                       {"nlopt-tnewton", {15.43, 24.33, 31}}};
  ExpectInBands("evaluations", samples, table);
}

}  // namespace
}  // namespace touchdown::evaluation
