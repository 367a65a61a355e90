// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "evaluation/base/file_lock.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/campaign.h"
#include "evaluation/campaign/sweep_cells.h"

namespace touchdown::evaluation {

/// The results in a file of trials, by trial; the single times of replans only if they are wanted.
/// @throws SqliteError, std::invalid_argument
std::map<int, TrialResult> ReadTrials(SqliteDb& db, bool with_replan_times);

/// The file of a campaign's trials while it grows (docs/record.md). It holds the plan from the start. From the moment
/// that Add returns, the trial is in it, whole and with the figures of its cell, whatever happens to the process later.
/// Others may read meanwhile.
class TrialStore {
 public:
  /// Which trials of an existing file are flown again: none, or those whose end depends more on the machine than on the
  /// trial. These crashed, hung or ended in an error.
  enum class Again { kNone, kLost };

  /// Makes the file, or continues the one that is there. `path` empty: in memory.
  /// @throws BadInput if the existing file is damaged, not of this campaign, shard and build, or if another process
  /// writes it; SqliteError, std::filesystem::filesystem_error
  TrialStore(const std::string& path, const Campaign& campaign, const Shard& shard,
             Again again = Again::kNone);
  ~TrialStore();
  TrialStore(const TrialStore&) = delete;
  TrialStore& operator=(const TrialStore&) = delete;

  bool Holds(int trial) const { return flown_.count(trial) > 0; }
  int succeeded() const { return succeeded_; }
  /// @throws SqliteError
  void Add(int trial, const TrialResult& result);
  /// The results in the file, by trial. @throws BadInput
  std::map<int, TrialResult> Results();

 private:
  void ForgetLost();
  void Count(int trial, const TrialResult& result);

  std::string path_;
  CellPlan cells_;
  std::vector<CellTally> tallies_;
  std::set<int> flown_;
  int succeeded_ = 0;
  std::unique_ptr<FileLock> lock_;
  std::unique_ptr<SqliteDb> db_;
};

/// A statement that inserts rows with this many columns.
SqliteStatement Insert(SqliteDb& db, const std::string& table, std::size_t columns);

/// Computes the figures of all cells anew, from the trials in the file. @throws SqliteError
void WriteCells(SqliteDb& db);

/// Writes a file of rows that were flown. @throws as TrialStore does
void WriteTrials(const std::string& path, const Campaign& campaign,
                 const std::vector<SweepRow>& rows);

}  // namespace touchdown::evaluation
