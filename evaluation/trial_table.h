// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "touchdown/evaluation/sweep.h"

namespace touchdown::evaluation {

/// Writes a study file (docs/record.md): tables `trial`, `variation`, `varied_key`, `cell`
/// and `cell_value` (deterministic), `timing` (wall clock) and `manifest`. The file appears whole or not at all.
/// @throws SqliteError, std::filesystem::filesystem_error
void WriteTrialTable(const std::string& path, const SweepOptions& options,
                     const std::vector<SweepRow>& rows);

}  // namespace touchdown::evaluation
