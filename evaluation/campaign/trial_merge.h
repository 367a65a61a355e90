// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::evaluation {

struct MergedTrials {
  int flown = 0;
  int planned = 0;
};

/// Writes the file `out` of all the trials in `files`, shards of one campaign: the same as if one process had flown
/// them. It appears whole or not at all. With `partial` trials may be missing: they can be flown later.
/// @throws BadInput if a file belongs to another campaign or build than the first, or if a trial is in two files or in
/// none. SqliteError, std::filesystem::filesystem_error
MergedTrials MergeTrials(const std::string& out, const std::vector<std::string>& files,
                         bool partial);

}  // namespace touchdown::evaluation
