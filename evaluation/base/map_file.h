// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "touchdown/planning/map/persistent_map.h"

namespace touchdown::evaluation {

/// Replaces `map` by the OctoMap file at `path` (.bt or .ot, told apart by their content).
/// @throws std::invalid_argument naming the file and what is wrong with it.
void ReadMapFile(const std::string& path, planning::PersistentMap* map);

/// Checks before a flight that a map can be written at `path` after it. `option` is the one that
/// named the path, for the sentence. @throws BadInput
void CheckMapPath(const std::string& option, const std::string& path);

/// Writes the map in the format that the path's ending names; the file appears whole or not at all.
/// @throws std::runtime_error naming the file.
void WriteMapFile(const std::string& path, planning::PersistentMap* map);

}  // namespace touchdown::evaluation
