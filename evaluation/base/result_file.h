// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/base/machine.h"
#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {

/// Facts for a result file's table `manifest`: pairs of key and value.
using ManifestFacts = std::vector<std::pair<std::string, std::string>>;

/// The format that a file states. A format whose tables change gets a new version: readers refuse versions that they do
/// not know.
struct ResultFormat {
  const char* name;
  int version;
};

/// Where times were taken: `pinned_cpu`, `load_before`, `load_after`.
void AddMachine(const MachineState& machine, ManifestFacts* facts);

/// Fills a result file in one transaction. It gets the table `manifest` (key, value) with `format`, `version`, the
/// facts and the build. It also gets the tables of `schema` (SQL), which `fill` fills. @throws SqliteError
void FillResultFile(SqliteDb& db, const ResultFormat& format, const char* schema,
                    const ManifestFacts& facts, const std::function<void(SqliteDb&)>& fill);

/// Whether the file has that table: then it is a result file, and no record of a flight.
bool HasManifest(SqliteDb& db);

/// Writes a result file, an SQLite file that appears at `path` when it is complete, see FillResultFile.
/// @throws SqliteError, std::filesystem::filesystem_error
void WriteResultFile(const std::string& path, const ResultFormat& format, const char* schema,
                     const ManifestFacts& facts, const std::function<void(SqliteDb&)>& fill);

}  // namespace touchdown::evaluation
