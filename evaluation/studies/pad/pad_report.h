// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/studies/pad/pad_study.h"

namespace touchdown::evaluation {

/// Tables for people.
std::string PadStudyText(const PadStudyOptions& options, const PadStudy& study);

nlohmann::ordered_json PadStudyJson(const PadStudyOptions& options, const PadStudy& study);

/// Every flight, every row and every cell of the study as an SQLite file, with a manifest. The file appears whole or
/// not at all. @throws SqliteError
void WritePadStudy(const std::string& path, const PadStudyOptions& options, const PadStudy& study);

}  // namespace touchdown::evaluation
