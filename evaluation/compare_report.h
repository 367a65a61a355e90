// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "touchdown/evaluation/compare.h"
#include "touchdown/evaluation/machine.h"

namespace touchdown::evaluation {

/// The comparison for people: a table for each number of points, refusals, the scaling.
std::string CompareText(const CompareOptions& options, const CompareResult& result);

/// The comparison for programs (docs/compare.md). A time that is infinite because a problem was not
/// solved is null.
nlohmann::ordered_json CompareJson(const CompareOptions& options, const CompareResult& result,
                                   const MachineState& machine);

/// The settings of a comparison as key and value, for JSON and manifest.
nlohmann::ordered_json CompareSettings(const CompareOptions& options);

}  // namespace touchdown::evaluation
