// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// The report of a sweep as one page: the summary, then every trial, what failed first. `flights` are pages that show
/// single trials, by their index (recorded_trials.h).
std::string SweepPage(const Campaign& campaign, const std::vector<SweepRow>& rows,
                      const std::map<int, std::string>& flights);

/// What links to such a page; empty: there is none.
std::string FlightLink(const std::map<int, std::string>& flights, int trial);

}  // namespace touchdown::evaluation
