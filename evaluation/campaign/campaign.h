// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/base/result_file.h"
#include "evaluation/judge/trial_result.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// One trial to be flown: everything that decides it.
struct SweepTrial {
  int index = 0;                                            ///< its place in the campaign, from 0
  std::uint64_t seed = 0;                                   ///< at most 2^53
  std::vector<std::pair<std::string, std::string>> varied;  ///< label and its value
  Scenario scenario;
  std::string command;  ///< `touchdown land SCENARIO --set ...`, without the seed

  /// The command that flies it alone.
  std::string Replay() const;
  /// Its plans take as long as the clock says. So it flies alone: beside others the flight would differ.
  bool FliesAlone() const;
};

/// A trial that was flown.
struct SweepRow {
  SweepTrial trial;
  TrialResult result;
};

/// The scenario of a trial, as `touchdown land SCENARIO --set ...` makes it, and that command; its place, seed
/// and labels are the caller's. `scenario_path` as FindScenario gives it. @throws BadInput as LoadScenario does
SweepTrial MakeTrial(const std::string& scenario_path, const std::vector<std::string>& overrides,
                     const Registries& registries);

/// A label of the trials.
struct VariedKey {
  std::string key;
  std::string unit;    ///< empty: none
  bool range = false;  ///< drawn from a range: its values make no cells
};

/// Trials that are flown and stored together. All have the same labels, those of `keys` in their order, and
/// trial i stands at place i. A cell is a combination of values of the labels that are not ranges.
struct Campaign {
  std::string name;  ///< "sweep"
  std::uint64_t seed = 1;
  std::vector<VariedKey> keys;
  std::vector<SweepTrial> trials;
  ManifestFacts facts;  ///< what else its file says of how it was asked for
};

/// The part of a campaign which one file holds: of trials 0, 1, ... those with index % of == number - 1.
struct Shard {
  int number = 1;
  int of = 1;

  /// "k/n". @throws BadInput
  static Shard Parse(const std::string& text);
  std::string ToString() const;
  bool Takes(int trial) const { return trial % of == number - 1; }
};

struct CampaignOptions {
  /// Trials that are flown at a time, except those that fly alone. Each rank of an MPI program flies one.
  int jobs = 1;
  std::string
      db;  ///< the file of the trials, which are added to one that is there; empty: none is kept
  Shard shard;
  double trial_limit_s = 1800.0;  ///< wall time after which a trial is given up, as `hung` [s]
  bool retry =
      false;  ///< trials in the file that crashed, hung or ended in an error are flown again
};

/// How far a campaign is.
struct CampaignState {
  int all = 0;        ///< trials of this shard
  int resumed = 0;    ///< of those, flown before
  int flown = 0;      ///< of those, flown, with those before
  int succeeded = 0;  ///< of the flown ones
};

struct CampaignResult {
  std::vector<SweepRow> rows;  ///< the flown trials of the shard by index, as the file holds them
  CampaignState state;
  int at_a_time = 1;  ///< trials that were flown at a time: jobs, or ranks
  /// Ended by SIGINT or SIGTERM before all were flown; what was flown is in the file.
  int interrupted_by = 0;
  /// False on ranks of an MPI program that only fly trials. Rank 0 has the rows and reports.
  bool reports = true;
};

/// Checks that this machine can fly the trials, so that a common failure is reported once, before the first.
/// @throws BadInput
void CheckTrials(const Campaign& campaign);

/// Flies the trials that its file does not hold yet, each in a process of its own. Trials that fly alone come after the
/// others. Each is added to the file when it ends. One that dies or takes too long becomes a row with outcome `crashed`
/// or `hung`. Except for trials that fly alone, the rows do not depend on jobs, ranks, shards or interruptions. The
/// calling process should have no other threads. `progress` is called once before the first trial and after each.
/// @throws BadInput if the file is of another campaign, build or shard; SqliteError
CampaignResult RunCampaign(const Campaign& campaign, const CampaignOptions& options,
                           const Registries& registries,
                           const std::function<void(const CampaignState&)>& progress);

/// The result of a trial that ended in an error.
TrialResult FailedTrial(const SweepTrial& trial, const std::string& what);

/// The same in this process, one trial after the other, for parts that exist only in this process. `fly` flies a trial.
/// What it throws ends the campaign; the flown trials are in the file.
CampaignResult FlyHere(const Campaign& campaign, const CampaignOptions& options,
                       const std::function<TrialResult(const SweepTrial&)>& fly,
                       const std::function<void(const CampaignState&)>& progress);

}  // namespace touchdown::evaluation
