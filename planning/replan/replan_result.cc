// SPDX-License-Identifier: BSD-3-Clause
// Names and sentences of the replanning statuses.

#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::planning {

const char* ToString(ReplanStatus status) {
  switch (status) {
    case ReplanStatus::kPlanned:
      return "planned";
    case ReplanStatus::kKept:
      return "kept";
    case ReplanStatus::kBraking:
      return "braking";
    case ReplanStatus::kClimbing:
      return "climbing";
    case ReplanStatus::kEscaping:
      return "escaping";
    case ReplanStatus::kHolding:
      return "holding";
    case ReplanStatus::kUnsafe:
      return "unsafe";
  }
  return "unknown";
}

const char* ToString(ReplanReason reason) {
  switch (reason) {
    case ReplanReason::kNone:
      return "none";
    case ReplanReason::kInvalidInput:
      return "invalid_input";
    case ReplanReason::kStartBlocked:
      return "start_blocked";
    case ReplanReason::kGoalBlocked:
      return "goal_blocked";
    case ReplanReason::kPadUnreachable:
      return "pad_unreachable";
    case ReplanReason::kSearchFailed:
      return "search_failed";
    case ReplanReason::kSolverFailed:
      return "solver_failed";
    case ReplanReason::kCollisionRemains:
      return "collision_remains";
    case ReplanReason::kUnobserved:
      return "unobserved";
    case ReplanReason::kEndTooFast:
      return "end_too_fast";
    case ReplanReason::kBudgetSpent:
      return "budget_spent";
    case ReplanReason::kLimitsExceeded:
      return "limits_exceeded";
    case ReplanReason::kAtGoal:
      return "at_goal";
  }
  return "unknown";
}

const char* Explain(ReplanStatus status) {
  switch (status) {
    case ReplanStatus::kPlanned:
      return "A new plan is flown.";
    case ReplanStatus::kKept:
      return "The committed curve is still safe and goes on.";
    case ReplanStatus::kBraking:
      return "The vehicle brakes to rest.";
    case ReplanStatus::kClimbing:
      return "The vehicle climbs to rest along a certified curve.";
    case ReplanStatus::kEscaping:
      return "The vehicle leaves the inflated zone around an obstacle and comes to rest.";
    case ReplanStatus::kHolding:
      return "The vehicle is at rest in free space and stays.";
    case ReplanStatus::kUnsafe:
      return "Nothing could be certified: the vehicle brakes without a certificate.";
  }
  return "Unknown status.";
}

const char* Explain(ReplanReason reason) {
  switch (reason) {
    case ReplanReason::kNone:
      return "A new plan was certified.";
    case ReplanReason::kInvalidInput:
      return "A number of the input is not finite or out of range, or an earlier answer has not "
             "taken over yet.";
    case ReplanReason::kStartBlocked:
      return "The start is inside an inflated obstacle and no certified path leads out.";
    case ReplanReason::kGoalBlocked:
      return "The end is inside an inflated obstacle, or beyond floor or ceiling, at every arrival "
             "time tried.";
    case ReplanReason::kPadUnreachable:
      return "The pad or goal drives away faster than the vehicle may fly.";
    case ReplanReason::kSearchFailed:
      return "No path around an obstacle was found, or the search used up its work.";
    case ReplanReason::kSolverFailed:
      return "The solver returned no usable point.";
    case ReplanReason::kCollisionRemains:
      return "The curve is still blocked after every re-binding round.";
    case ReplanReason::kUnobserved:
      return "The plan is too fast to stop before space that was never observed.";
    case ReplanReason::kEndTooFast:
      return "The pad is faster than 90 % of limits.speed: hard limits cannot be kept.";
    case ReplanReason::kBudgetSpent:
      return "The step used up its work before there was a plan.";
    case ReplanReason::kLimitsExceeded:
      return "The curve still exceeds a limit after every re-timing.";
    case ReplanReason::kAtGoal:
      return "The goal is too near for a plan of the baseline.";
  }
  return "unknown";
}

}  // namespace touchdown::planning
