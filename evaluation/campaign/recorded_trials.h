// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// A trial that is to be looked at.
struct RecordedTrial {
  const SweepTrial* trial = nullptr;
  const TrialResult* flown = nullptr;  ///< what it came to; nullptr: not known
  std::string path;  ///< without ending: its record is path.db, its page path.html
};

/// Flies trials again from their scenario and seed, each in a process of its own, and writes of each a record and a page that
/// shows it (docs/replay.md). What is there already of this flight, by this build, is kept; what is there of another is
/// removed. Of what fails the log is told: the campaign is complete without it. A trial whose plans take as long as the clock
/// says may fly otherwise than before; the log is told. Returns those that are there in the end.
std::vector<RecordedTrial> RecordTrials(const std::vector<RecordedTrial>& trials,
                                        const CampaignOptions& options,
                                        const Registries& registries);

/// Which flown trials are recorded: `none`, `failures` (what ended in a crash of the program, in an error or hung is not flown
/// again) or `all`.
enum class Recorded { kNone, kFailures, kAll };
/// Throws std::invalid_argument for another word.
Recorded RecordedNamed(const std::string& name);

/// Those of them that are to be.
std::vector<const SweepRow*> ToRecord(const std::vector<SweepRow>& rows, Recorded which);

/// Records those of `rows` into the folder of the report at `page`, `F_flights` beside F.html, and gives, by the trial's index,
/// the page of each that is there, relative to the report, at the moment when it failed. @throws BadInput if the folder cannot be made.
std::map<int, std::string> RecordFlown(const std::string& page, const std::vector<SweepRow>& rows,
                                       Recorded which, const CampaignOptions& options,
                                       const Registries& registries);

}  // namespace touchdown::evaluation
