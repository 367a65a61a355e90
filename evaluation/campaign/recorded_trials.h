// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// A trial to be recorded.
struct RecordedTrial {
  const SweepTrial* trial = nullptr;
  const TrialResult* flown = nullptr;  ///< its result; nullptr: not known
  std::string path;  ///< without ending: its record is path.db, its page path.html
};

/// Flies trials again from their scenario and seed, each in its own process. For each it writes a record and a page
/// that shows it (docs/replay.md). Files of the same flight by this build are kept; files of another flight are
/// removed. Failures are logged: the campaign is complete without them. If plans take as long as the clock says, a
/// trial may fly differently from before; this is logged too. Returns the trials that have a record in the end.
std::vector<RecordedTrial> RecordTrials(const std::vector<RecordedTrial>& trials,
                                        const CampaignOptions& options,
                                        const Registries& registries);

/// Which flown trials are recorded: `none`, `failures` or `all`. `failures` leaves out trials that crashed the program,
/// ended in an error or hung.
enum class Recorded { kNone, kFailures, kAll };
/// Throws std::invalid_argument for another word.
Recorded RecordedNamed(const std::string& name);

/// Those of them that are to be recorded.
std::vector<const SweepRow*> ToRecord(const std::vector<SweepRow>& rows, Recorded which);

/// Records those of `rows` into the folder of the report at `page`, `F_flights` beside F.html. Returns, by the trial's
/// index, the page of each recorded trial at the moment when it failed, relative to the report. @throws BadInput if the
/// folder cannot be made.
std::map<int, std::string> RecordFlown(const std::string& page, const std::vector<SweepRow>& rows,
                                       Recorded which, const CampaignOptions& options,
                                       const Registries& registries);

}  // namespace touchdown::evaluation
