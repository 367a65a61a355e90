// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "evaluation/base/machine.h"
#include "evaluation/compare/reference_compare.h"

namespace touchdown::evaluation {

/// Writes a comparison on a set of known problems to an SQLite file (docs/compare.md): manifest, problems, every
/// solve, refusals. The file appears at its path only when it is complete. @throws SqliteError,
/// std::filesystem::filesystem_error
void WriteReferenceTable(const std::string& path, const ReferenceOptions& options,
                         const ReferenceResult& result, const MachineState& machine);

}  // namespace touchdown::evaluation
