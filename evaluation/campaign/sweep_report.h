// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// The table that `touchdown sweep` prints, of at least one row; beside each failure the command that
/// flies it alone.
std::string SweepText(const Campaign& campaign, const std::vector<SweepRow>& rows);

/// The document of `touchdown sweep --json`: summary, failures, trials. Everything but `wall_clock`
/// is the same for the same options, whichever machine flew the trials.
nlohmann::ordered_json SweepJson(const Campaign& campaign, const std::vector<SweepRow>& rows);

}  // namespace touchdown::evaluation
