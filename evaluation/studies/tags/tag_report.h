// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/studies/tags/tag_study.h"

namespace touchdown::evaluation {

/// Views of one camera.
struct TagStudyPart {
  TagStudyOptions options;
  std::vector<TagStudyRow> rows;
};

/// Demands on the pose from images without noise: medians of the position error [mm].
inline constexpr double kNearErrorMm = 3.0;  ///< below kNearHeight
inline constexpr double kFarErrorMm = 15.0;  ///< from there to kHighestView
inline constexpr double kNearHeight = 4.0;   ///< [m]

/// Whether the views fulfil the demand.
bool FulfilsDemand(const std::vector<TagStudyRow>& rows);

/// Tables for people.
std::string TagStudyText(const std::vector<TagStudyPart>& parts);

nlohmann::ordered_json TagStudyJson(const std::vector<TagStudyPart>& parts);

/// Every view and every tag of it as rows of an SQLite file, with a manifest. The file appears whole
/// or not at all. @throws SqliteError
void WriteTagStudy(const std::string& path, const std::vector<TagStudyPart>& parts);

}  // namespace touchdown::evaluation
