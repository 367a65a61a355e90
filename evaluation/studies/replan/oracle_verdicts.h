// SPDX-License-Identifier: BSD-3-Clause
// Verdicts of the oracle on the common scenes, stored so that they are computed once.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "evaluation/studies/replan/replan_study.h"

namespace touchdown::evaluation {

/// Verdicts by set, kind, seed and scene, of scenes with the usual horizon, resolution and density.
class OracleVerdicts {
 public:
  OracleVerdicts() = default;

  /// Reads a CSV file. @throws BadInput with file and line.
  explicit OracleVerdicts(const std::string& path);

  /// None: nothing is known of such a scene.
  std::optional<OracleVerdict> Find(const SceneOptions& scenes, int index) const;

  /// Takes up the verdicts of these rows, in the order of their scenes.
  void Add(const SceneOptions& scenes, const std::vector<ReplanRow>& rows);

  /// The file appears whole or not at all. @throws BadInput
  void Write(const std::string& path) const;

 private:
  using Key = std::tuple<std::string, std::string, std::uint64_t>;  // set, kind, seed
  std::map<Key, std::string> verdicts_;                             // a letter each
};

/// The verdicts that are installed, or in the build tree. @throws BadInput if they are in neither.
OracleVerdicts StandardOracleVerdicts();

}  // namespace touchdown::evaluation
