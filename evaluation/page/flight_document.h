// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// A recorded flight as one document, which a page can show without the record (docs/replay.md). `name` is the record's
/// name for readers. The landing planner's steps are asked again; `done(n, all)` is called after each.
/// @throws BadInput as ReadRecord and Replay.
nlohmann::ordered_json FlightDocument(const std::string& record, const std::string& name,
                                      const Registries& registries,
                                      const std::function<void(int, int)>& done);

}  // namespace touchdown::evaluation
