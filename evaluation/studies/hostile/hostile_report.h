// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/campaign/campaign.h"
#include "evaluation/studies/hostile/hostile_study.h"
#include "evaluation/studies/hostile/hostile_tally.h"

namespace touchdown::evaluation {

/// What `touchdown study hostile` prints. Two tables by family, within and beyond the assumptions, come first. Then
/// follows every flight that did not land, with the command that flies it again.
std::string HostileText(const HostileOptions& options, const std::vector<SweepRow>& rows);

/// The same as JSON. Nothing in it depends on who flew the flights.
nlohmann::ordered_json HostileJson(const HostileOptions& options,
                                   const std::vector<SweepRow>& rows);

/// The same as one HTML page, with a top view of one world of each family. `flights` are pages that show single ones
/// (recorded_trials.h).
std::string HostilePage(const HostileOptions& options, const std::vector<SweepRow>& rows,
                        const std::map<int, std::string>& flights, const Registries& registries);

/// Where a way exists, by family, of flights that are not flown.
std::string HostileWaysText(const std::vector<HostileFlight>& flights);

/// Time to land of each flight that landed, by its seed, of a campaign's file.
using HostileTimes = std::map<std::uint64_t, double>;

/// @throws BadInput if the file at `path` is no file of `touchdown study hostile` with the same seed.
HostileTimes ReadHostileTimes(const HostileOptions& options, const std::string& path);

/// Ratios of times to land, flight by flight, to those of the same flights in another campaign, by family.
std::string HostilePairsText(const std::vector<SweepRow>& rows, const HostileTimes& others);

/// Figures of the safety rule: names and values, in the order in which reports print them.
using SafetyLines = std::vector<std::pair<std::string, std::string>>;
SafetyLines SafetyFacts(const HostileTally& tally);

/// "3 of 120 [0.5, 7.1] %", with the 95 % Clopper-Pearson interval; "0 of 0" without any.
std::string RateText(int count, int of);

}  // namespace touchdown::evaluation
