// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/control/onboard/envelope.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {

/// The replanner's options for a scenario and its vehicle; `terms` are those it may use.
planning::ReplannerOptions PlannerOptions(const Scenario& scenario,
                                          const estimation::VehicleModel& model,
                                          const planning::TermRegistry& terms);

/// Where the landing planner's terms act, of those that give it.
std::vector<planning::NamedZone> ZonesOf(const planning::ReplannerOptions& options);

/// The planner that the scenario asks for.
std::unique_ptr<planning::Planner> MakePlanner(const Scenario& scenario,
                                               const estimation::VehicleModel& model,
                                               const Registries& registries);

/// Its entry. Throws std::invalid_argument if there is none of that name.
const PlannerEntry& PlannerOf(const Scenario& scenario, const Registries& registries);

/// How often it is to be called [Hz]: at its own rate, or at planning.rate.
double PlannerRate(const Scenario& scenario, const PlannerEntry& planner);

/// The same shortly before a planned landing's contact [Hz]: at least 20 Hz, if the latency leaves room.
double ClosePlannerRate(const Scenario& scenario, const PlannerEntry& planner);

/// The scenario's terms.<name>.* as the planner takes them.
planning::TermSettings TermSettingsOf(const std::string& name,
                                      const std::map<std::string, double>& keys);

/// What the vehicle may do in flight.
control::Envelope EnvelopeOf(const Scenario& scenario);

/// How far plans stay from obstacles [m]: planning.clearance. For a planner that proves pairs it is
/// at least what these keep in calm air: the hull at every tilt and its margins.
double PlanClearance(const Scenario& scenario, const estimation::VehicleModel& model,
                     const Registries& registries);

/// Longest time from the question to the plan [s]: the least time between two replanning steps. A
/// plan that takes over later would still wait when the next one is asked for.
double LongestLatency(const Scenario& scenario);

}  // namespace touchdown::evaluation
