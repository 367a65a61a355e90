// SPDX-License-Identifier: BSD-3-Clause
// The EGO-Planner baseline by its keys; their defaults are as published.
#include "touchdown/evaluation/planner_entry.h"
#include "touchdown/planning/ego/ego_planner.h"

namespace touchdown::evaluation {
namespace {

planning::EgoPlannerOptions OptionsOf(const PlannerSetup& setup, bool goal_velocity) {
  planning::EgoPlannerOptions options;
  options.plan.max_speed = setup.limits.speed;
  options.plan.max_acceleration = setup.limits.acceleration;
  options.plan.horizon = setup.Get("ego.horizon");
  options.plan.control_point_distance = setup.Get("ego.control_point_distance");
  options.plan.clearance = setup.Get("ego.clearance");
  options.plan.replan_distance = setup.Get("ego.replan_distance");
  options.plan.no_replan_distance = setup.Get("ego.no_replan_distance");
  options.plan.emergency_time = setup.Get("ego.emergency_time");
  options.goal_rate = setup.Get("ego.goal_rate");
  options.goal_velocity = goal_velocity;
  options.floor_height = setup.floor_height;
  options.ceiling_height = setup.ceiling_height;
  return options;
}

PlannerEntry EgoEntry(const char* name, const char* summary, bool goal_velocity) {
  PlannerEntry entry;
  entry.name = name;
  entry.summary = summary;
  entry.rate = planning::EgoPlanner::kRate;
  entry.solver = "lbfgs";
  entry.parameters = {
      {"ego.goal_rate",
       5.0,
       {0.1, 100, false, "Hz"},
       "planner ego: the pad's position is sent as a new goal so often"},
      {"ego.horizon", 7.5, {1, 50, false, "m"}, "planner ego: distance of the local target"},
      {"ego.control_point_distance",
       0.4,
       {0.05, 2, false, "m"},
       "planner ego: nominal spacing of control points"},
      {"ego.clearance", 0.5, {0, 3, false, "m"}, "planner ego: wanted beyond the grown obstacles"},
      {"ego.replan_distance",
       1.5,
       {0, 50, false, "m"},
       "planner ego: flown before it replans for no other reason"},
      {"ego.no_replan_distance",
       2.0,
       {0, 50, false, "m"},
       "planner ego: to the goal, nearer it replans for none"},
      {"ego.emergency_time",
       1.0,
       {0, 10, false, "s"},
       "planner ego: a collision sooner than this stops the vehicle"},
  };
  entry.make = [goal_velocity](const PlannerSetup& setup) {
    return std::make_unique<planning::EgoPlanner>(OptionsOf(setup, goal_velocity));
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
