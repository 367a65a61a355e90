// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "touchdown/evaluation/scenario.h"
#include "touchdown/evaluation/trial_result.h"

namespace touchdown::evaluation {

/// The document of `touchdown land --json`. Everything but `wall_clock` is the same for the same
/// scenario and seed.
nlohmann::ordered_json LandJson(const Scenario& scenario, const TrialResult& result);

/// {median, p95, p99, max} of `values`; nulls when there are none.
nlohmann::ordered_json QuantilesJson(const std::vector<double>& values);

/// Of replanning steps with these wall times, `late` of which took longer than the latency that they were flown
/// with: "largest 3.41 ms, 0 of 88 longer than their latency". @pre there is one.
std::string SlowStepsText(const std::vector<double>& wall_ms, int late);

}  // namespace touchdown::evaluation
