// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "touchdown/evaluation/scenario.h"
#include "touchdown/evaluation/trial_result.h"

namespace touchdown::evaluation {

/// The document of `touchdown land --json`. Everything but `wall_clock` is the same for the same
/// scenario and seed.
nlohmann::ordered_json LandJson(const Scenario& scenario, const TrialResult& result);

/// {median, p95, p99, max} of `values`; nulls when there are none.
nlohmann::ordered_json QuantilesJson(const std::vector<double>& values);

}  // namespace touchdown::evaluation
