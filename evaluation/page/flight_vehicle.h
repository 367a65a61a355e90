// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The vehicle of a scenario for a replay's document: `shapes` as they are to be seen, `rotors`, `cameras` with their
/// frusta, `hull`. @throws std::invalid_argument naming its file.
nlohmann::ordered_json VehicleDocument(const Scenario& scenario);

/// The pad: the deck, the body below it, and the printed sheet as runs of white and black texels, row by row from the top.
nlohmann::ordered_json PadDocument(const Scenario& scenario);

}  // namespace touchdown::evaluation
