// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "evaluation/base/machine.h"
#include "evaluation/compare/compare.h"

namespace touchdown::evaluation {

/// Writes a comparison to an SQLite file (docs/compare.md): manifest, problems, every solve, refusals
/// and the summary. The file appears at its path only when it is complete. @throws SqliteError,
/// std::filesystem::filesystem_error
void WriteCompareTable(const std::string& path, const CompareOptions& options,
                       const CompareResult& result, const MachineState& machine);

}  // namespace touchdown::evaluation
