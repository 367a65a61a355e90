// SPDX-License-Identifier: BSD-3-Clause
// The EGO-Planner baseline by its keys; their defaults are as published.
#include "planning/baselines/ego/ego_planner.h"
#include "touchdown/evaluation/scenario/planner_entry.h"

namespace touchdown::evaluation {
namespace {

using Options = planning::EgoPlannerOptions;

const std::vector<OptionKey<Options>>& EgoKeys() {
  static const std::vector<OptionKey<Options>> keys = {
      {"ego.goal_rate",
       [](Options& o) -> double& { return o.goal_rate; },
       {0.1, 100, false, "Hz"},
       "planner ego: rate at which the pad's position is sent as a new goal"},
      {"ego.horizon",
       [](Options& o) -> double& { return o.plan.horizon; },
       {1, 50, false, "m"},
       "planner ego: distance of the local target"},
      {"ego.control_point_distance",
       [](Options& o) -> double& { return o.plan.control_point_distance; },
       {0.05, 2, false, "m"},
       "planner ego: nominal spacing of control points"},
      {"ego.clearance",
       [](Options& o) -> double& { return o.plan.clearance; },
       {0, 3, false, "m"},
       "planner ego: wanted beyond the grown obstacles"},
      {"ego.replan_distance",
       [](Options& o) -> double& { return o.plan.replan_distance; },
       {0, 50, false, "m"},
       "planner ego: flown before it replans for no other reason"},
      {"ego.no_replan_distance",
       [](Options& o) -> double& { return o.plan.no_replan_distance; },
       {0, 50, false, "m"},
       "planner ego: to the goal, nearer it replans for none"},
      {"ego.emergency_time",
       [](Options& o) -> double& { return o.plan.emergency_time; },
       {0, 10, false, "s"},
       "planner ego: a collision sooner than this stops the vehicle"},
  };
  return keys;
}

PlannerEntry EgoEntry(const char* name, const char* summary, bool goal_velocity) {
  PlannerEntry entry;
  entry.name = name;
  entry.summary = summary;
  entry.rate = planning::EgoPlanner::kRate;
  entry.solver = "lbfgs";
  entry.parameters = ParametersOf(EgoKeys());
  entry.make = [goal_velocity](const PlannerSetup& setup) {
    Options options;
    Set(setup, EgoKeys(), &options);
    options.plan.max_speed = setup.limits.speed;
    options.plan.max_acceleration = setup.limits.acceleration;
    options.goal_velocity = goal_velocity;
    options.floor_height = setup.floor_height;
    options.ceiling_height = setup.ceiling_height;
    return std::make_unique<planning::EgoPlanner>(options);
  };
  return entry;
}

}  // namespace

PlannerEntry EgoPlannerAtRest() {
  return EgoEntry("ego", "EGO-Planner baseline as published; the pad's position as a goal at rest",
                  false);
}

PlannerEntry EgoPlannerWithVelocity() {
  return EgoEntry("ego-velocity", "the same with the pad's velocity at the goal", true);
}

}  // namespace touchdown::evaluation
