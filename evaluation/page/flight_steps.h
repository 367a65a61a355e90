// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/record/record_reader.h"

namespace touchdown::evaluation {

/// Every replanning step of a flight for a replay's document: question and answer. For the landing planner, which is
/// asked again, also the ways that it tried, its pairs, stages and messages. `done(n, all)` is called after each step.
/// @throws BadInput as Replay.
nlohmann::ordered_json StepsDocument(const RecordedFlight& flight, const Registries& registries,
                                     const std::function<void(int, int)>& done);

/// The known map at each step, as changes: `resolution` [m], `size` of its window [cells], and `steps`. A step has the
/// window's lowest cell and runs: x y z count state x y z count state ...
nlohmann::ordered_json MapDocument(const RecordedFlight& flight);

}  // namespace touchdown::evaluation
