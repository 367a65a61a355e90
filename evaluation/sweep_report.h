// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "touchdown/evaluation/sweep.h"

namespace touchdown::evaluation {

/// The table that `touchdown sweep` prints.
std::string SweepText(const SweepOptions& options, const std::vector<SweepRow>& rows);

/// The document of `touchdown sweep --json`: summary, failures, trials. Everything but `wall_clock`
/// is the same for the same options, whatever the number of threads.
nlohmann::ordered_json SweepJson(const SweepOptions& options, const std::vector<SweepRow>& rows);

}  // namespace touchdown::evaluation
