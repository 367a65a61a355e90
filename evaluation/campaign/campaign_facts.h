// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// Files of trials.
inline constexpr ResultFormat kTrialFormat{"touchdown trials", 9};
inline constexpr char kFileOfTrials[] = "file of trials";  ///< in a sentence

/// The facts of a campaign's file for its manifest, without the build. `plan_hash` is a hash of everything that decides
/// the trials except the build: seeds, labels, scenarios, and the files that these name.
ManifestFacts FactsOf(const Campaign& campaign, const Shard& shard);

/// A hash of everything that the results depend on: `plan_hash` and the build.
std::string CampaignHash(const Campaign& campaign);

/// By key.
using Manifest = std::map<std::string, std::string>;

/// Empty where the manifest lacks it.
std::string Fact(const Manifest& manifest, const std::string& key);

/// The manifest of the file at `path`. @throws BadInput if it is no file of trials, or of another version.
Manifest ReadManifest(SqliteDb& db, const std::string& path);

/// Compares two manifests in all that decides results. @return the differences, in words that continue the name of the
/// file of `there`; empty: they may be joined.
std::string Difference(const Manifest& there, const Manifest& here);

}  // namespace touchdown::evaluation
