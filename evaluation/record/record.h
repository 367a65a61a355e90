// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "evaluation/flight/trial_record.h"
#include "evaluation/judge/trial_result.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Version of the file format that docs/record.md describes.
inline constexpr int kRecordVersion = 20;

/// Writes one landing to an SQLite file (docs/record.md). The file appears whole or not at all. It
/// is written beside its place and moved there, and replaces an older one.
/// @throws SqliteError, std::filesystem::filesystem_error
void WriteRecord(const std::string& path, const Scenario& scenario, const TrialResult& result,
                 const TrialRecord& record);

}  // namespace touchdown::evaluation
