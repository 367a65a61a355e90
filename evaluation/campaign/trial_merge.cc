// SPDX-License-Identifier: BSD-3-Clause
// The plan is in every shard and is taken from the first. The flown trials are copied row by row. The figures of the
// cells, which no shard can know, are computed anew.
#include "evaluation/campaign/trial_merge.h"

#include <map>
#include <memory>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/campaign/trial_store.h"

namespace touchdown::evaluation {
namespace {

struct Input {
  std::string path;
  std::unique_ptr<SqliteDb> db;
  Manifest manifest;
};

std::vector<Input> Open(const std::vector<std::string>& files) {
  std::vector<Input> inputs;
  for (const std::string& path : files) {
    Input& input = inputs.emplace_back();
    input.path = path;
    NamingFile(path, kFileOfTrials, [&] {
      input.db = std::make_unique<SqliteDb>(path, SqliteDb::Mode::kReadOnly);
      // All data of a file are from one moment, even if it still grows.
      input.db->Execute("BEGIN");
      input.manifest = ReadManifest(*input.db, path);
      ReadTrials(*input.db, true);
    });
    const std::string other = Difference(inputs.back().manifest, inputs.front().manifest);
    if (!other.empty()) {
      throw BadInput(fmt::format("{}: it does not belong to {}: {}.", path, files.front(), other));
    }
  }
  return inputs;
}

std::vector<int> Trials(SqliteDb& db, const char* table) {
  std::vector<int> trials;
  SqliteStatement rows = db.Prepare(fmt::format("SELECT trial FROM {} ORDER BY trial", table));
  while (rows.Step()) trials.push_back(static_cast<int>(rows.Integer(0)));
  return trials;
}

// Every trial in one file and no more. @throws BadInput
MergedTrials CheckTrials(const std::vector<Input>& inputs, bool partial) {
  std::map<int, const Input*> flown;
  for (const Input& input : inputs) {
    for (const int trial : Trials(*input.db, "trial")) {
      const auto [at, fresh] = flown.emplace(trial, &input);
      if (fresh) continue;
      throw BadInput(
          fmt::format("{}: trial {} is in {} as well.", input.path, trial, at->second->path));
    }
  }
  const std::vector<int> planned = Trials(*inputs.front().db, "planned");
  const MergedTrials count{static_cast<int>(flown.size()), static_cast<int>(planned.size())};
  for (const int trial : planned) {
    if (partial || flown.count(trial) > 0) continue;
    throw BadInput(
        fmt::format("{} of {} trials are in none of the files, the first of them is trial {}; "
                    "--partial merges what there is.",
                    count.planned - count.flown, count.planned, trial));
  }
  return count;
}

void CopyRows(SqliteDb& from, const std::string& table, SqliteDb& to) {
  SqliteStatement rows = from.Prepare("SELECT * FROM " + table);
  std::unique_ptr<SqliteStatement> insert;
  while (rows.Step()) {
    const std::vector<SqlValue> row = rows.Row();
    if (!insert) insert = std::make_unique<SqliteStatement>(Insert(to, table, row.size()));
    insert->RunRow(row);
  }
}

void MakeTables(SqliteDb& like, SqliteDb& db) {
  SqliteStatement tables = like.Prepare("SELECT sql FROM sqlite_master WHERE type = 'table'");
  while (tables.Step()) db.Execute(tables.Text(0));
}

}  // namespace

MergedTrials MergeTrials(const std::string& out, const std::vector<std::string>& files,
                         bool partial) {
  const std::vector<Input> inputs = Open(files);
  const MergedTrials count = CheckTrials(inputs, partial);
  AtomicFile file(out);
  {
    SqliteDb db(file.working_path(), SqliteDb::Mode::kCreate);
    db.Execute("PRAGMA journal_mode=OFF");  // it is written once and as a whole
    SqliteTransaction transaction(db);
    NamingFile(inputs.front().path, kFileOfTrials, [&] {
      SqliteDb& first = *inputs.front().db;
      MakeTables(first, db);
      for (const char* table :
           {"manifest", "planned", "variation", "varied_key", "cell", "cell_value"}) {
        CopyRows(first, table, db);
      }
    });
    db.Prepare("UPDATE manifest SET value = ? WHERE key = 'shard'").Run(Shard().ToString());
    for (const Input& input : inputs) {
      NamingFile(input.path, kFileOfTrials, [&] {
        for (const char* table : {"trial", "timing", "replan_time"}) CopyRows(*input.db, table, db);
      });
    }
    WriteCells(db);
    transaction.Commit();
  }
  if (!file.CommitNew()) throw BadInput(fmt::format("{}: the file exists.", out));
  return count;
}

}  // namespace touchdown::evaluation
