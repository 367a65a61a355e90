// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The vehicle of a scenario for a replay's document: `shapes` as they are to be seen, `rotors`, `cameras` with their
/// frusta. @throws std::invalid_argument naming its file.
nlohmann::ordered_json VehicleDocument(const Scenario& scenario);

/// Where a flight of the task go_to leads: `p` at t = 0 and `v`, in W; null of other tasks.
nlohmann::ordered_json GoalDocument(const Scenario& scenario);

/// The pad: the deck, the body below it, the edge of a plate that covers the printed sheet, and the sheet. The sheet is
/// given as runs of white and black texels, row by row from the top.
nlohmann::ordered_json PadDocument(const Scenario& scenario);

}  // namespace touchdown::evaluation
