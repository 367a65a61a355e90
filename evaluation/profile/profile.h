// SPDX-License-Identifier: BSD-3-Clause
// What replanning costs, in a closed loop or on the recorded inputs of a flight.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/compare/compare_summary.h"
#include "evaluation/flight/trial_samples.h"
#include "evaluation/record/record_reader.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/planning/replan/span_log.h"

namespace touchdown::evaluation {

/// One flight, or one pass over the steps of a record.
struct ProfileRun {
  std::uint64_t seed = 0;
  std::string outcome;  ///< of the flight; "replayed"
  TrialSamples samples;
  int warm_up = 0;             ///< first replanning steps whose allocations do not count
  std::size_t first_span = 0;  ///< of this run in the profile's log
};

struct Profile {
  Scenario scenario;
  std::string record;  ///< replayed from; empty: flown
  double deadline_ms = 0.0;
  std::vector<ProfileRun> runs;
  planning::SpanLog spans;  ///< of all runs, in their order, if they were asked for
  bool allocations_counted = false;
  int compared = 0;  ///< replayed answers that were held against the record
  int same = 0;      ///< of these, the same bit for bit
};

/// Called after each run with the number of runs done and of all.
using ProfileProgress = std::function<void(int, int)>;

struct ProfileOptions {
  int trials = 1;                     ///< flights, seeds scenario.seed, scenario.seed + 1, ...
  int repeats = 5;                    ///< measured passes over a record, after one that is not
  std::optional<double> deadline_ms;  ///< wall; none: DefaultDeadlineMs
  bool spans = false;
};

/// The latency that plans are flown with; where it is measured or zero, the replanning period.
double DefaultDeadlineMs(const Scenario& scenario);

/// @throws BadInput as RunTrial
Profile ProfileFlights(const Scenario& scenario, const ProfileOptions& options,
                       const Registries& registries, const ProfileProgress& progress);

/// Every recorded step from its recorded state, first in a pass that is compared with the record and
/// not measured, then `repeats` times. @throws BadInput as Replay, or for a record without steps.
Profile ProfileRecord(const RecordedFlight& flight, const ProfileOptions& options,
                      const Registries& registries, const ProfileProgress& progress);

/// One stage over all its samples. A replanning step that does without a stage counts with zero.
struct StageSummary {
  std::string stage;
  int samples = 0;
  int used = 0;  ///< samples that spent time in it
  Quantiles cpu_ms, wall_ms;
  Quantiles allocations;  ///< after the warm-up, if they are counted
};

struct ProfileSummary {
  /// First sense and map of the depth images, where there are any. Then the stages of the
  /// replanning step, and the rest of it as "other".
  std::vector<StageSummary> stages;
  StageSummary total;
  int deadline_misses = 0;  ///< steps whose wall time exceeded the deadline
  /// The steps that took longest, slowest first: of a replay by the median of its passes.
  struct SlowStep {
    int step = 0;
    std::uint64_t seed = 0;  ///< of the flight
    double cpu_ms = 0.0;     ///< thread CPU time
    int solves = 0;
  };
  std::vector<SlowStep> slowest;
};
ProfileSummary Summarise(const Profile& profile);

}  // namespace touchdown::evaluation
