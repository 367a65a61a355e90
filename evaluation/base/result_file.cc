// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/result_file.h"

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/build_info.h"

namespace touchdown::evaluation {
void AddMachine(const MachineState& machine, ManifestFacts* facts) {
  facts->emplace_back("pinned_cpu", machine.pinned ? std::to_string(*machine.pinned) : "none");
  facts->emplace_back("load_before", std::to_string(machine.load_before));
  facts->emplace_back("load_after", std::to_string(machine.load_after));
}

void FillResultFile(SqliteDb& db, const ResultFormat& format, const char* schema,
                    const ManifestFacts& facts, const std::function<void(SqliteDb&)>& fill) {
  SqliteTransaction transaction(db);
  db.Execute("CREATE TABLE manifest(key TEXT PRIMARY KEY, value TEXT NOT NULL)");
  db.Execute(schema);
  {
    SqliteStatement manifest = db.Prepare("INSERT INTO manifest VALUES(?, ?)");
    manifest.Run("format", format.name);
    manifest.Run("version", std::to_string(format.version));
    for (const auto& [key, value] : facts) manifest.Run(key, value);
    for (const auto& [key, value] : BuildManifest()) manifest.Run(key, value);
  }
  fill(db);
  transaction.Commit();
}

bool HasManifest(SqliteDb& db) {
  SqliteStatement found =
      db.Prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'manifest'");
  return found.Step();
}

void WriteResultFile(const std::string& path, const ResultFormat& format, const char* schema,
                     const ManifestFacts& facts, const std::function<void(SqliteDb&)>& fill) {
  AtomicFile file(path);
  {
    SqliteDb db(file.working_path(), SqliteDb::Mode::kCreate);
    // It is written once and as a whole: there is nothing to roll back to.
    db.Execute("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF");
    FillResultFile(db, format, schema, facts, fill);
  }
  file.Commit();
}

}  // namespace touchdown::evaluation
