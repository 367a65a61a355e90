// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/base/machine.h"
#include "evaluation/compare/compare.h"
#include "evaluation/compare/compare_summary.h"

namespace touchdown::evaluation {

/// The comparison for people: problems, a table, refusals.
std::string CompareText(const CompareOptions& options, const CompareResult& result);

/// The comparison for programs (docs/compare.md). A time that is infinite because a problem was not
/// solved is null.
nlohmann::ordered_json CompareJson(const CompareOptions& options, const CompareResult& result,
                                   const MachineState& machine);

/// The source of its problems, and their kind.
std::string CompareProblemsText(const CompareResult& result);
nlohmann::ordered_json CompareProblemsJson(const CompareResult& result);

/// "281 of 281", or of a backend that did not run all "66 of 66 run, of 297".
std::string SolvedText(const BackendSummary& summary, int all);
nlohmann::ordered_json BackendSummaryJson(const BackendSummary& summary);
nlohmann::ordered_json RefusalsJson(const std::vector<Refusal>& refusals);

/// The settings of a comparison as key and value, for JSON and manifest.
nlohmann::ordered_json CompareSettings(const CompareOptions& options);

}  // namespace touchdown::evaluation
