// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/estimation/vehicle_model.h"
#include "touchdown/evaluation/scenario.h"
#include "touchdown/planning/ego/ego_planner.h"
#include "touchdown/planning/pid/pid_follower.h"
#include "touchdown/planning/replanner.h"

namespace touchdown::evaluation {

/// What the replanner is told of a scenario and its vehicle; `terms` are those it may use.
planning::ReplannerOptions PlannerOptions(const Scenario& scenario,
                                          const estimation::VehicleModel& model,
                                          const planning::TermRegistry& terms);

/// What the EGO-Planner baseline is told: its own parameters, the vehicle's limits per axis, and the
/// floor and ceiling that the replanner has.
planning::EgoPlannerOptions EgoPlannerOptionsOf(const Scenario& scenario,
                                                const estimation::VehicleModel& model);

/// The planner that the scenario asks for.
std::unique_ptr<planning::Planner> MakePlanner(const Scenario& scenario,
                                               const estimation::VehicleModel& model,
                                               const Registries& registries);

/// The solver of that planner: the baselines have one of their own, or "none".
std::string BackendName(const Scenario& scenario);

/// How often it is to be called [Hz]: the landing planner at planning.rate, the baselines at the
/// rates of their state machine and law.
double PlannerRate(const Scenario& scenario);

/// The same shortly before a planned landing's contact [Hz]: at least 20 Hz, if the latency leaves room.
double ClosePlannerRate(const Scenario& scenario);

/// The scenario's terms.<name>.* as the planner takes them.
planning::TermSettings TermSettingsOf(const std::string& name,
                                      const std::map<std::string, double>& keys);

/// How far the tracking law may tilt: farther than plans, which do not count on all of it [rad].
double TrackingTilt(const Scenario& scenario);

/// How far plans stay from obstacles: planning.clearance, but no less than what the landing planner's pairs
/// keep in calm air, the hull at every tilt and its margins [m].
double PlanClearance(const Scenario& scenario, const estimation::VehicleModel& model);

/// Plans stay above this away from the pad [m].
double LowestPlan(const estimation::VehicleModel& model);

/// Longest time from the question to the plan [s]: the least time between two replanning steps. A
/// plan that took over later would still be waiting when the next one is asked for.
double LongestLatency(const Scenario& scenario);

}  // namespace touchdown::evaluation
