// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <variant>

namespace touchdown::planning {

/// The numbers that decide a step on its way to a plan, beside the budgets and counts of ReplannerOptions. Those of
/// the ladder below a plan are in fallback_ladder.cc and fallback.cc. `StepConstantTable` explains each. `touchdown
/// study replan --parts sensitivity` measures their effect.
struct StepConstants {
  // Ways past what blocks a curve (path_finder.h).
  double heuristic_weight = 2.0;
  double tight_cost = 8.0;
  double detour_longer = 2.0;
  double hold_beside_time = 0.5;
  double path_cost_ratio = 1.05;
  double side_change_ratio = 0.8;

  // From a way to a clear curve (plan_attempt.h, pair_binder.h).
  double near_obstacle = 1.5;
  double fine_segments = 0.5;
  double bound_beside = 2.0;
  double stand_off = 0.3;
  double pair_growth = 2.5;
  double blocked_share_left = 0.5;
  double limit_growth = 6.0;
  double limit_far = 1.06;
  int limit_rounds = 2;

  // What is kept from step to step.
  double look_every = 0.5;
  double kept_latest = 1.06;
  double retime_below = 0.75;
  double near_contact = 3.0;

  // The ladder of attempts (attempt_ladder.h).
  double stretch = 1.4;
  double end_step = 1.05;
  double grid_longest = 1.2;
  double unseen_reach = 1.0;
  double unseen_least = 0.5;
};

/// What a constant is.
struct StepConstant {
  const char* name;
  std::variant<double StepConstants::*, int StepConstants::*> value;
  const char* unit;     ///< "" for a pure number
  const char* meaning;  ///< a phrase
  double least = 0.0;   ///< from which it counts: 1 for what is so many times something at least
};

/// All of them, in the order above.
std::span<const StepConstant> StepConstantTable();

double ValueOf(const StepConstants& constants, const StepConstant& which);

/// The constants with one of them at so many times its distance from its least value. A count is rounded, and changed
/// by one at least. Throws std::invalid_argument unless factor is positive and finite.
StepConstants Scaled(const StepConstants& constants, const StepConstant& which, double factor);

}  // namespace touchdown::planning
