// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::planning {

/// What an attempt of a step is made with.
struct Rung {
  int attempt = 0;        ///< made before this one
  double duration = 0.0;  ///< T, or its first guess [s]
  ArrivalMode arrival = ArrivalMode::kFixed;
  double unseen_reach =
      0.0;  ///< around the start, where a plan keeps to what was seen [m]; 0: nowhere
};

/// How it ended.
struct Outcome {
  ReplanReason reason = ReplanReason::kNone;
  double duration = 0.0;  ///< of the plan that was tried last [s]
};

/// What the ladder depends on besides, the same for all attempts of a step.
struct LadderFacts {
  bool lands_soon = false;  ///< the committed plan is about to touch the deck
  bool at_rest = false;
  ArrivalMode arrival = ArrivalMode::kFixed;  ///< that is wanted
  double fresh = 0.0;                         ///< guess of the duration from this start [s]
  double min_duration = 0.0;                  ///< [s]
  double max_duration = 0.0;                  ///< [s]
};

/// The next attempt, or why there is none.
struct Climb {
  std::optional<Rung> next;
  ReplanReason reason = ReplanReason::kNone;
};

/// What comes after an attempt without a plan: the first rule of a table (attempt_ladder.cc) that holds.
Climb NextRung(const Rung& rung, const Outcome& outcome, const LadderFacts& facts,
               const StepConstants& constants);

}  // namespace touchdown::planning
