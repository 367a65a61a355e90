// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "evaluation/judge/trial_result.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Mean |error| in x and y over the last 5 s [m] of a landing whose style follows the pad before it sinks. Empty for a
/// planned descent: it is still on its way then, so its figure is not comparable.
std::optional<Eigen::Vector2d> LastErrors(const Scenario& scenario, const TrialResult& result);

/// The document of `touchdown land --json`. Everything but `wall_clock` is the same for the same
/// scenario and seed.
nlohmann::ordered_json LandJson(const Scenario& scenario, const TrialResult& result);

/// {median, p95, p99, max} of `values`; nulls when there are none.
nlohmann::ordered_json QuantilesJson(const std::vector<double>& values);

}  // namespace touchdown::evaluation
