// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/vehicle_model.h"
#include "touchdown/evaluation/scenario.h"
#include "touchdown/planning/replanner.h"

namespace touchdown::evaluation {

/// What the replanner is told of a scenario and its vehicle; `terms` are those it may use.
planning::ReplannerOptions PlannerOptions(const Scenario& scenario,
                                          const estimation::VehicleModel& model,
                                          const planning::TermRegistry& terms);

/// The scenario's terms.<name>.* as the planner takes them.
planning::TermSettings TermSettingsOf(const std::string& name,
                                      const std::map<std::string, double>& keys);

/// Plans stay above this away from the pad [m].
double LowestPlan(const estimation::VehicleModel& model);

/// Longest time from the question to the plan [s]: the least time between two replanning steps. A
/// plan that took over later would still be waiting when the next one is asked for.
double LongestLatency(const Scenario& scenario);

}  // namespace touchdown::evaluation
