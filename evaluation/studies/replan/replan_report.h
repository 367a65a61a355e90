// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/base/machine.h"
#include "evaluation/studies/replan/replan_study.h"

namespace touchdown::evaluation {

/// Steps of one kind of scenes under one set of options.
struct ReplanStudyPart {
  std::string part;    ///< safety, growth
  std::string varied;  ///< growth: the setting that differs from the usual one
  ReplanStudyOptions options;
  std::vector<ReplanRow> rows;
};

/// Tables for people.
std::string ReplanStudyText(const std::vector<ReplanStudyPart>& parts);

nlohmann::ordered_json ReplanStudyJson(const std::vector<ReplanStudyPart>& parts,
                                       const MachineState& machine);

/// Every step as a row of an SQLite file, with a manifest. The file appears whole or not at all.
/// @throws SqliteError
void WriteReplanStudy(const std::string& path, const std::vector<ReplanStudyPart>& parts,
                      const MachineState& machine);

}  // namespace touchdown::evaluation
