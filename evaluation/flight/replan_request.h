// SPDX-License-Identifier: BSD-3-Clause
// A question to the replanner as data, so that it can be written down and asked again.
#pragma once

#include <optional>

#include "touchdown/evaluation/scenario/predictor_entry.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {

/// "velocity", "heading" or "turn".
const char* ToString(estimation::PadMotion motion);

struct ReplanRequest {
  planning::ReplanInput input;       ///< without its pad
  std::optional<double> rest_climb;  ///< to rest, this much higher [m]; none: to the pad
  std::optional<PadKnowledge>
      pad;  ///< from which the scenario's predictor foretells it; none: it is not known
};

}  // namespace touchdown::evaluation
