// SPDX-License-Identifier: BSD-3-Clause
// Checks the EGO-Planner baseline: its first plan calls beside the measured quantiles of the released program's.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/base/statistics.h"
#include "evaluation/studies/fidelity/ego_scene.h"

namespace touchdown::evaluation {

/// One quantity of a kind of scenes, ours beside the measured one.
struct EgoFidelityRow {
  std::string kind;
  std::string quantity;
  int scenes = 0;         ///< that ours was taken over
  double upstream = 0.0;  ///< median, or share of successes
  double ours = 0.0;
  Interval interval;   ///< 95 %, of the ratio of medians (bootstrap) or of the share
  bool met = false;    ///< ratio: the interval meets [0.85, 1.15]; share: within 3 points
  bool judged = true;  ///< the rest is for information
};

/// Compares results of a kind with the measured quantiles in the CSV file at `path`. Deterministic.
/// @throws BadInput if the file cannot be read or lacks the kind.
std::vector<EgoFidelityRow> CompareWithUpstream(const SceneKind& kind,
                                                const std::vector<EgoSceneResult>& results,
                                                const std::string& path);

/// Where the measured quantiles are: installed, or in the build tree. @throws BadInput if they are in neither.
std::string EgoQuantilesPath();

/// Every judged row meets its rule.
bool Faithful(const std::vector<EgoFidelityRow>& rows);

/// A table for people.
std::string EgoFidelityText(const std::vector<EgoFidelityRow>& rows);

nlohmann::ordered_json EgoFidelityJson(const std::vector<EgoFidelityRow>& rows, std::uint64_t seed);

}  // namespace touchdown::evaluation
