// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/campaign/campaign.h"
#include "evaluation/campaign/study_file.h"

namespace touchdown::evaluation {

/// A method in a cell.
struct StudyPart {
  int cell = 0;    ///< of the file's cells
  int method = 0;  ///< of the file's methods
  int trials = 0;
  int first = 0;        ///< of the campaign's trials
  std::string refusal;  ///< why it is not flown; empty: it is
};

/// The part of a study to fly.
struct StudySelection {
  bool quick = false;                ///< the short form
  std::vector<std::string> cells;    ///< names; empty: all
  std::vector<std::string> methods;  ///< names; empty: all
  std::optional<int> trials;         ///< of each method in each cell; none: as the file says

  /// A part: neither the whole study nor its short form.
  bool Part() const { return !cells.empty() || !methods.empty() || trials.has_value(); }
};

/// Everything that a study is to fly.
struct StudyPlan {
  StudyFile file;
  StudySelection selection;
  std::vector<StudyPart> parts;  ///< cell by cell, in the order of the file
  Campaign campaign;             ///< part by part; labels `cell`, `method` and the cell's own

  const StudyCell& CellOf(const StudyPart& part) const;
  const StudyMethod& MethodOf(const StudyPart& part) const;
  /// Its first trial is to be recorded.
  bool Records(const StudyPart& part) const;
};

/// Plans a study. Trial i of every part has the same seed, TrialSeed(seed, i) (common random numbers), also in a part
/// that is selected alone.
/// @throws BadInput as LoadScenario does; but a backend of a study may refuse a cell. Also for a selection that names
/// something unknown, or is empty.
StudyPlan PlanStudy(const StudyFile& file, const StudySelection& selection, std::uint64_t seed,
                    const Registries& registries);

/// What the report needs to know beside the trials (docs/record.md).
nlohmann::ordered_json StudyJson(const StudyPlan& plan);

}  // namespace touchdown::evaluation
