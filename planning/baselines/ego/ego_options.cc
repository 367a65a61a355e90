// SPDX-License-Identifier: BSD-3-Clause
// Ranges of the baseline's parameters, and the names of its outcomes.

#include "planning/baselines/ego/ego_options.h"

#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

void Require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument(std::string("EgoOptions: ") + name + " is " + std::to_string(value) +
                              ", it must be " + range);
}

}  // namespace

void Validate(const EgoOptions& o) {
  Require(o.max_speed > 0.0, "max_speed", o.max_speed, "> 0 m/s");
  Require(o.max_acceleration > 0.0, "max_acceleration", o.max_acceleration, "> 0 m/s^2");
  Require(o.horizon > 0.0, "horizon", o.horizon, "> 0 m");
  Require(o.control_point_distance > 0.0, "control_point_distance", o.control_point_distance,
          "> 0 m");
  Require(o.clearance >= 0.0, "clearance", o.clearance, ">= 0 m");
  Require(o.limit_tolerance >= 0.0, "limit_tolerance", o.limit_tolerance, ">= 0");
  Require(o.memory >= 1, "memory", o.memory, ">= 1");
  Require(o.max_iterations >= 1, "max_iterations", o.max_iterations, ">= 1");
  Require(o.max_restarts >= 1, "max_restarts", o.max_restarts, ">= 1");
  Require(o.max_rebounds >= 0, "max_rebounds", o.max_rebounds, ">= 0");
  Require(o.search_step > 0.0, "search_step", o.search_step, "> 0 m");
  Require(o.search_cells >= 4 && o.search_cells <= 400, "search_cells", o.search_cells,
          "in [4, 400]");
  Require(o.search_expansions >= 1, "search_expansions", o.search_expansions, ">= 1");
}

const char* ToString(EgoStatus status) {
  switch (status) {
    case EgoStatus::kPlanned:
      return "planned";
    case EgoStatus::kInvalidInput:
      return "invalid_input";
    case EgoStatus::kCloseToGoal:
      return "close_to_goal";
    case EgoStatus::kOutsideMap:
      return "outside_map";
    case EgoStatus::kNoInitialPath:
      return "no_initial_path";
    case EgoStatus::kStartInObstacle:
      return "start_in_obstacle";
    case EgoStatus::kTerminalBlocked:
      return "terminal_blocked";
    case EgoStatus::kSearchFailed:
      return "search_failed";
    case EgoStatus::kRestartsUsedUp:
      return "restarts_used_up";
    case EgoStatus::kReboundsUsedUp:
      return "rebounds_used_up";
    case EgoStatus::kPairLookupEmpty:
      return "pair_lookup_empty";
    case EgoStatus::kSolverFailed:
      return "solver_failed";
    case EgoStatus::kRefinementHit:
      return "refinement_hit";
  }
  return "unknown";
}

const char* Explain(EgoStatus status) {
  switch (status) {
    case EgoStatus::kPlanned:
      return "There is a new trajectory.";
    case EgoStatus::kInvalidInput:
      return "A number of the request is not finite.";
    case EgoStatus::kCloseToGoal:
      return "The local target is nearer than 0.2 m.";
    case EgoStatus::kOutsideMap:
      return "The start lies outside the map.";
    case EgoStatus::kNoInitialPath:
      return "No sampling of the first guess suits.";
    case EgoStatus::kStartInObstacle:
      return "The curve is blocked within its first knot interval.";
    case EgoStatus::kTerminalBlocked:
      return "The terminal point of the trajectory is in an obstacle.";
    case EgoStatus::kSearchFailed:
      return "The curve is blocked, and the search found no way around an obstacle.";
    case EgoStatus::kRestartsUsedUp:
      return "The curve is still blocked after every restart.";
    case EgoStatus::kReboundsUsedUp:
      return "The curve still meets new obstacles after every rebound.";
    case EgoStatus::kPairLookupEmpty:
      return "A control point shall copy a pair that its neighbour does not have.";
    case EgoStatus::kSolverFailed:
      return "A line search of the optimiser gave up.";
    case EgoStatus::kRefinementHit:
      return "The curve that was slowed down is blocked.";
  }
  return "Unknown.";
}

}  // namespace touchdown::planning
