// SPDX-License-Identifier: BSD-3-Clause
// A question to the planner as data, so that it can be written down and asked again.
#pragma once

#include <optional>

#include "touchdown/estimation/pad/pad_predictor.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::control {

struct ReplanRequest {
  planning::ReplanInput input;       ///< without its pad
  std::optional<double> rest_climb;  ///< to rest, this much higher [m]; none: to the pad
  std::optional<estimation::PadKnowledge>
      pad;  ///< from which the predictor predicts it; none: the pad is not known
};

/// The inputs of a replanning step.
struct OnboardReplan {
  ReplanRequest request;
  estimation::PadState pad;  ///< the prediction at t_now
  double latency_s = 0.0;    ///< with which the plan is flown
  planning::StageTimes::Span look{"look"};  ///< what the scout took before the step
  bool late = false;         ///< a new pair took over later than that
};

}  // namespace touchdown::control
