// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::planning {

/// The settings of one attempt of a step.
struct Attempt {
  int number = 0;         ///< attempts before this one
  double duration = 0.0;  ///< T, or its first guess [s]
  ArrivalMode arrival = ArrivalMode::kFixed;
  double unseen_reach = 0.0;  ///< around the start a plan keeps to observed cells [m]; 0: nowhere
};

/// The result of an attempt.
struct Outcome {
  ReplanReason reason = ReplanReason::kNone;
  double duration = 0.0;  ///< of the last plan that was tried [s]
};

/// Further inputs of the rules, the same for all attempts of a step.
struct AttemptFacts {
  bool lands_soon = false;  ///< the committed plan is about to touch the deck, ...
  bool lands_well = false;  ///< ... and holds: no later one is needed
  bool at_rest = false;
  ArrivalMode arrival = ArrivalMode::kFixed;  ///< that the options ask for
  double fresh = 0.0;                         ///< guess of the duration from this start [s]
  double min_duration = 0.0;                  ///< [s]
  double max_duration = 0.0;                  ///< [s]
};

/// The next attempt, or the reason why there is none.
struct AttemptDecision {
  std::optional<Attempt> next;
  ReplanReason reason = ReplanReason::kNone;
};

/// The decision after an attempt without a plan: the first rule of a table (attempt_ladder.cc) that holds.
AttemptDecision NextAttempt(const Attempt& attempt, const Outcome& outcome,
                            const AttemptFacts& facts, const StepConstants& constants);

}  // namespace touchdown::planning
