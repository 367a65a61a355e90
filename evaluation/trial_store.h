// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "touchdown/evaluation/campaign.h"
#include "touchdown/evaluation/file_lock.h"
#include "touchdown/evaluation/sqlite_db.h"
#include "touchdown/evaluation/sweep_cells.h"

namespace touchdown::evaluation {

/// The file of a campaign's trials while it grows (docs/record.md). It holds from the start what is planned;
/// each trial is there, whole and with the figures of its cell, from the moment that Add returns, whatever
/// happens to the process later. Others may read meanwhile.
class TrialStore {
 public:
  /// Makes the file, or goes on with the one that is there. `path` empty: in memory.
  /// @throws BadInput if the file there is none of this campaign, shard and build, or is being written by
  /// another process; SqliteError, std::filesystem::filesystem_error
  TrialStore(const std::string& path, const Campaign& campaign, const Shard& shard);
  ~TrialStore();
  TrialStore(const TrialStore&) = delete;
  TrialStore& operator=(const TrialStore&) = delete;

  bool Holds(int trial) const { return flown_.count(trial) > 0; }
  /// @throws SqliteError
  void Add(int trial, const TrialResult& result);
  /// By trial; what the file says. @throws SqliteError
  std::map<int, TrialResult> Results();

 private:
  void Count(int trial, const TrialResult& result);
  void WriteCell(int cell);

  CellPlan cells_;
  std::vector<CellTally> tallies_;
  std::set<int> flown_;
  std::unique_ptr<FileLock> lock_;
  std::unique_ptr<SqliteDb> db_;
};

/// The results in a file of trials, by trial. @throws SqliteError, std::invalid_argument
std::map<int, TrialResult> ReadTrials(SqliteDb& db);

/// Writes a file of rows that were flown. @throws as TrialStore does
void WriteTrials(const std::string& path, const Campaign& campaign,
                 const std::vector<SweepRow>& rows);

}  // namespace touchdown::evaluation
