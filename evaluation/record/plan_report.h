// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/record/plan_case.h"

namespace touchdown::evaluation {

/// A solved step in words: question, attempts with their rounds and costs, certificate, answer.
std::string PlanText(const SolvedStep& solved);

/// The document of `touchdown plan --json` (docs/profile.md). `drawn`: with the occupied cells of
/// the map, for the picture.
nlohmann::ordered_json PlanJson(const SolvedStep& solved, bool drawn);

}  // namespace touchdown::evaluation
