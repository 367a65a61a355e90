// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// One key of a sweep that changes from trial to trial.
struct Variation {
  std::string text;  ///< as it was written
  std::string key;
  std::vector<std::string> values;  ///< taken in turn by all combinations; empty: a range
  double lo = 0.0;                  ///< otherwise drawn uniformly in [lo, hi] per trial
  double hi = 0.0;

  /// "KEY=LO..HI" or "KEY=a,b,c". @throws BadInput
  static Variation Parse(const std::string& text, const Registries& registries);
};

struct SweepOptions {
  std::string scenario_path;
  std::vector<std::string> overrides;  ///< as --set
  std::vector<Variation> variations;
  int trials = 20;
  std::uint64_t seed = 1;
};

/// Seed of trial `index` in a sweep with seed `sweep_seed`.
std::uint64_t TrialSeed(std::uint64_t sweep_seed, int index);

/// The trials of a sweep, each scenario checked. Trial i takes combination i modulo the number of
/// combinations of all listed values; ranges are drawn from a stream of the trial's seed.
/// @throws BadInput
std::vector<SweepTrial> PlanSweep(const SweepOptions& options, const Registries& registries);

/// The same with what their file says of them. @throws BadInput
Campaign SweepCampaign(const SweepOptions& options, const Registries& registries);

}  // namespace touchdown::evaluation
