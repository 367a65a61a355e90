// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// Files of trials.
inline constexpr ResultFormat kTrialFormat{"touchdown trials", 8};

/// What the manifest of a campaign's file says besides the build. `plan_hash` is one figure for everything
/// but the build that decides the trials: their seeds, labels and scenarios, and the files that these name.
ManifestFacts FactsOf(const Campaign& campaign, const Shard& shard);

/// One figure for everything that the results depend on: `plan_hash` and the build.
std::string CampaignHash(const Campaign& campaign);

/// By key.
using Manifest = std::map<std::string, std::string>;

/// The manifest of the file at `path`. @throws BadInput if it is no file of trials, or of another version.
Manifest ReadManifest(SqliteDb& db, const std::string& path);

/// Compares two manifests in all that decides results. @return what differs, in words that go on from the
/// name of the file of `there`; empty: they may be joined.
std::string Difference(const Manifest& there, const Manifest& here);

}  // namespace touchdown::evaluation
