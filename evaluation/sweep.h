// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "touchdown/evaluation/scenario.h"
#include "touchdown/evaluation/trial_result.h"

namespace touchdown::evaluation {

/// One key of a sweep that changes from trial to trial.
struct Variation {
  std::string text;  ///< as it was written
  std::string key;
  std::vector<std::string> values;  ///< taken in turn by all combinations; empty: a range
  double lo = 0.0;                  ///< otherwise drawn uniformly in [lo, hi] per trial
  double hi = 0.0;

  /// "KEY=LO..HI" or "KEY=a,b,c". @throws BadInput
  static Variation Parse(const std::string& text);
};

struct SweepOptions {
  std::string scenario_path;
  std::vector<std::string> overrides;  ///< as --set
  std::vector<Variation> variations;
  int trials = 20;
  int jobs = 1;
  std::uint64_t seed = 1;
};

/// One planned trial: everything that decides it.
struct SweepTrial {
  int index = 0;
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, std::string>> varied;  ///< key and value
  Scenario scenario;
};

struct SweepRow {
  SweepTrial trial;
  TrialResult result;
};

/// Seed of trial `index` in a sweep with seed `sweep_seed`.
std::uint64_t TrialSeed(std::uint64_t sweep_seed, int index);

/// The trials of a sweep, each scenario checked. Trial i takes combination i modulo the number of
/// combinations of all listed values; ranges are drawn from a stream of the trial's seed.
/// @throws BadInput
std::vector<SweepTrial> PlanSweep(const SweepOptions& options, const Registries& registries);

/// Runs the trials on `jobs` threads. Rows come back in the order of the trials and do not depend
/// on `jobs`. A trial that throws becomes a row with outcome `error`. `progress` is called after
/// each trial with the numbers done and in all, never from two threads at a time.
std::vector<SweepRow> RunSweep(const std::vector<SweepTrial>& trials, int jobs,
                               const Registries& registries,
                               const std::function<void(int done, int all)>& progress);

}  // namespace touchdown::evaluation
