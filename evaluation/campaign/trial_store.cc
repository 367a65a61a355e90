// SPDX-License-Identifier: BSD-3-Clause
// One row per trial, in one transaction with the figures of its cell. The journal is SQLite's write-ahead log. A
// process that is killed leaves at most a log, which every later reader, a read-only one too, takes into account. What
// depends on the clock is in tables of its own, so that two files can be compared row by row.
#include "evaluation/campaign/trial_store.h"

#include <filesystem>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/build_info.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/campaign/trial_columns.h"

namespace touchdown::evaluation {
namespace {

std::string Marks(int columns) {
  std::string marks = "?";
  for (int i = 1; i < columns; ++i) marks += ", ?";
  return marks;
}

void WritePlan(SqliteDb& db, const Campaign& campaign, const CellPlan& cells) {
  SqliteStatement planned = Insert(db, "planned", 4), variation = Insert(db, "variation", 3),
                  key = Insert(db, "varied_key", 3), cell = Insert(db, "cell", 8),
                  value = Insert(db, "cell_value", 3);
  for (const VariedKey& k : campaign.keys) key.Run(k.key, k.unit, k.range ? "range" : "list");
  const SqlValue null;
  for (std::size_t i = 0; i < cells.cells.size(); ++i) {
    const int id = static_cast<int>(i);
    cell.Run(id, cells.cells[i].trials, 0, 0, null, null, null, null);
    for (const auto& [name, of_cell] : cells.cells[i].values) value.Run(id, name, of_cell);
  }
  for (const SweepTrial& trial : campaign.trials) {
    const int of_cell = cells.cell_of[static_cast<std::size_t>(trial.index)];
    planned.Run(trial.index, of_cell, static_cast<std::int64_t>(trial.seed), trial.Replay());
    for (const auto& [name, of_trial] : trial.varied) variation.Run(trial.index, name, of_trial);
  }
}

void WriteCell(SqliteDb& db, int cell, const CellFigures& f) {
  std::optional<double> lo, hi;
  if (f.rate) std::tie(lo, hi) = std::pair(f.rate->lo, f.rate->hi);
  db.Prepare(
        "UPDATE cell SET trials = ?, succeeded = ?, rate_lo = ?, rate_hi = ?, "
        "time_to_land_median_s = ?, touchdown_error_median_m = ? WHERE cell = ?")
      .Run(f.trials, f.succeeded, lo, hi, f.time_to_land_median_s, f.touchdown_error_median_m,
           cell);
}

void Fill(SqliteDb& db, const Campaign& campaign, const Shard& shard, const CellPlan& cells) {
  FillResultFile(db, kTrialFormat, TrialSchema().c_str(), FactsOf(campaign, shard),
                 [&](SqliteDb&) { WritePlan(db, campaign, cells); });
}

void Create(const std::string& path, const Campaign& campaign, const Shard& shard,
            const CellPlan& cells) {
  // The log of a removed file may still be there. SQLite would apply it to this file.
  for (const char* of_log : {"-wal", "-shm", "-journal"}) std::filesystem::remove(path + of_log);
  AtomicFile file(path);
  {
    SqliteDb db(file.working_path(), SqliteDb::Mode::kCreate);
    db.Execute("PRAGMA journal_mode=OFF");
    Fill(db, campaign, shard, cells);
  }
  file.CommitNew();  // or another process was faster: then that one's file is looked at
}

void CheckIsThis(SqliteDb& db, const std::string& path, const Campaign& campaign,
                 const Shard& shard) {
  const Manifest there = ReadManifest(db, path);
  Manifest here;
  for (const auto& [key, value] : FactsOf(campaign, shard)) here[key] = value;
  for (const auto& [key, value] : BuildManifest()) here[key] = value;
  std::string words = Difference(there, here);
  if (words.empty() && Fact(there, "shard") != shard.ToString()) {
    words = fmt::format("its shard is {}, not {}", Fact(there, "shard"), shard.ToString());
  }
  if (words.empty()) return;
  throw BadInput(fmt::format("{}: it holds trials of another sweep: {}.", path, words));
}

}  // namespace

SqliteStatement Insert(SqliteDb& db, const std::string& table, std::size_t columns) {
  return db.Prepare(
      fmt::format("INSERT INTO {} VALUES({})", table, Marks(static_cast<int>(columns))));
}

TrialStore::TrialStore(const std::string& path, const Campaign& campaign, const Shard& shard,
                       Again again)
    : path_(path), cells_(PlanCells(campaign)), tallies_(cells_.cells.size()) {
  if (path.empty()) {
    db_ = std::make_unique<SqliteDb>(":memory:", SqliteDb::Mode::kCreate);
    Fill(*db_, campaign, shard, cells_);
    return;
  }
  if (!std::filesystem::exists(path)) Create(path, campaign, shard, cells_);
  lock_ = std::make_unique<FileLock>(path);
  NamingFile(path, kFileOfTrials, [&] {
    db_ = std::make_unique<SqliteDb>(path, SqliteDb::Mode::kReadWrite);
    CheckIsThis(*db_, path, campaign, shard);
    db_->Execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL");
    if (again == Again::kLost) ForgetLost();
    for (const auto& [trial, result] : ReadTrials(*db_, false)) Count(trial, result);
  });
}

TrialStore::~TrialStore() {
  if (!db_) return;
  try {
    // Becomes one file again, which can be copied. If it is being read just now it keeps its log, which is as good.
    db_->Execute("PRAGMA busy_timeout=0; PRAGMA journal_mode=DELETE");
  } catch (const SqliteError&) {
  }
}

void TrialStore::ForgetLost() {
  std::string names;
  for (int i = 0; i <= static_cast<int>(kLastOutcome); ++i) {
    const auto outcome = static_cast<Outcome>(i);
    if (!IsLost(outcome)) continue;
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", ToString(outcome));
  }
  const std::string lost =
      fmt::format("trial IN (SELECT trial FROM trial WHERE outcome IN ({}))", names);
  SqliteTransaction transaction(*db_);
  for (const char* table : {"replan_time", "timing", "trial"}) {
    db_->Execute(fmt::format("DELETE FROM {} WHERE {}", table, lost));
  }
  WriteCells(*db_);
  transaction.Commit();
}

void TrialStore::Count(int trial, const TrialResult& result) {
  flown_.insert(trial);
  succeeded_ += result.succeeded() ? 1 : 0;
  if (trial < 0 || trial >= static_cast<int>(cells_.cell_of.size())) {
    throw std::invalid_argument(
        fmt::format("it holds trial {} of {}", trial, cells_.cell_of.size()));
  }
  const int cell = cells_.cell_of[static_cast<std::size_t>(trial)];
  tallies_[static_cast<std::size_t>(cell)].Add(result);
}

void WriteCells(SqliteDb& db) {
  std::map<int, CellTally> tallies;
  const std::map<int, TrialResult> results = ReadTrials(db, false);
  SqliteStatement planned = db.Prepare("SELECT trial, cell FROM planned");
  while (planned.Step()) {
    CellTally& tally = tallies[static_cast<int>(planned.Integer(1))];
    const auto result = results.find(static_cast<int>(planned.Integer(0)));
    if (result != results.end()) tally.Add(result->second);
  }
  for (const auto& [cell, tally] : tallies) WriteCell(db, cell, tally.Figures());
}

void TrialStore::Add(int trial, const TrialResult& result) {
  const TrialValues values = ValuesOf(result);
  SqliteTransaction transaction(*db_);
  Insert(*db_, "trial", values.trial.size() + 1).RunRow(trial, values.trial);
  Insert(*db_, "timing", values.timing.size() + 1).RunRow(trial, values.timing);
  SqliteStatement replan = Insert(*db_, "replan_time", 4);
  const TrialTiming& timing = result.timing;
  for (std::size_t i = 0; i < timing.replan_wall_ms.size(); ++i) {
    replan.Run(trial, static_cast<int>(i), timing.replan_wall_ms[i], timing.replan_cpu_ms.at(i));
  }
  Count(trial, result);
  const int cell = cells_.cell_of[static_cast<std::size_t>(trial)];
  WriteCell(*db_, cell, tallies_[static_cast<std::size_t>(cell)].Figures());
  transaction.Commit();
}

std::map<int, TrialResult> TrialStore::Results() {
  return NamingFile(path_, kFileOfTrials, [this] { return ReadTrials(*db_, true); });
}

std::map<int, TrialResult> ReadTrials(SqliteDb& db, bool with_replan_times) {
  SqliteStatement strays = db.Prepare(
      "SELECT trial FROM trial WHERE trial NOT IN (SELECT trial FROM planned) UNION "
      "SELECT trial FROM replan_time WHERE trial NOT IN (SELECT trial FROM trial)");
  if (strays.Step()) {
    throw std::invalid_argument(
        fmt::format("it holds figures of trial {}, which was not flown", strays.Integer(0)));
  }
  std::map<int, TrialResult> results;
  SqliteStatement trial = db.Prepare("SELECT * FROM trial ORDER BY trial");
  SqliteStatement timing = db.Prepare("SELECT * FROM timing ORDER BY trial");
  while (trial.Step()) {
    if (!timing.Step() || timing.Integer(0) != trial.Integer(0)) {
      throw std::invalid_argument(fmt::format("its trial {} has no timing", trial.Integer(0)));
    }
    results[static_cast<int>(trial.Integer(0))] = ResultOf({trial.Row(1), timing.Row(1)});
  }
  if (!with_replan_times) return results;
  SqliteStatement replan =
      db.Prepare("SELECT trial, wall_ms, cpu_ms FROM replan_time ORDER BY trial, replan");
  while (replan.Step()) {
    TrialTiming& of_trial = results.at(static_cast<int>(replan.Integer(0))).timing;
    of_trial.replan_wall_ms.push_back(replan.Real(1));
    of_trial.replan_cpu_ms.push_back(replan.Real(2));
  }
  return results;
}

void WriteTrials(const std::string& path, const Campaign& campaign,
                 const std::vector<SweepRow>& rows) {
  TrialStore store(path, campaign, {});
  for (const SweepRow& row : rows) store.Add(row.trial.index, row.result);
}

}  // namespace touchdown::evaluation
