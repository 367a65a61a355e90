// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/base/machine.h"
#include "evaluation/profile/profile.h"

namespace touchdown::evaluation {

/// A profile as a table for people.
std::string ProfileText(const Profile& profile);

/// The document of `touchdown profile --json` (docs/profile.md).
nlohmann::ordered_json ProfileJson(const Profile& profile, const MachineState& machine);

/// The spans in the Chrome trace event format, which Perfetto and chrome://tracing load: complete
/// events, one track for perception and one for planning.
nlohmann::ordered_json ChromeTrace(const Profile& profile);

/// Writes every sample to an SQLite file (docs/profile.md). The file appears at its path only when
/// it is complete. @throws SqliteError, std::filesystem::filesystem_error
void WriteProfileTable(const std::string& path, const Profile& profile,
                       const MachineState& machine);

}  // namespace touchdown::evaluation
