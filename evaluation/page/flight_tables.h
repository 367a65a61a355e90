// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {

/// The parts of a replay's document that are tables of its record (docs/record.md), by columns: `samples`, `events`,
/// `obstacles`, `zones`, `prior`, `result`, `scenario_yaml` and `build`.
/// @throws SqliteError, std::invalid_argument with words that go on from the file's name.
nlohmann::ordered_json FlightTables(SqliteDb& db);

}  // namespace touchdown::evaluation
