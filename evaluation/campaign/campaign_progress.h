// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "evaluation/base/progress.h"
#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// "37 of 100 trials, 36 succeeded and 1 failed, 1.21 a second, 52 s left". The time left follows from the rate since
/// the beginning, `elapsed_s` ago [s]. Rate and time left do not include trials flown before.
std::string CampaignLine(const CampaignState& state, double elapsed_s);

/// Tells the log what is resumed, then how far a campaign is.
class CampaignProgress {
 public:
  void operator()(const CampaignState& state);

 private:
  std::optional<ProgressPrinter> tell_;  ///< from the first call on
};

/// Logs how far an interrupted campaign came and where its trials are: in the file `db`; empty: nowhere. Returns the
/// exit status: 128 plus the signal's number, as in a shell.
int Interrupted(const CampaignResult& result, const std::string& db);

}  // namespace touchdown::evaluation
