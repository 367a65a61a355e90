// SPDX-License-Identifier: BSD-3-Clause
// From a scenario's keys to the planner's options.
#include "evaluation/scenario/planner_options.h"

#include <algorithm>
#include <cmath>

#include "planning/replan/prepared_problems.h"
#include "sim/world/world.h"

namespace touchdown::evaluation {
namespace {

constexpr double kCloseRate = 20.0;  // [Hz]
constexpr double kClockSteps = 2.0;  // that a step may come late on the simulation's clock

}  // namespace

planning::TermSettings TermSettingsOf(const std::string& name,
                                      const std::map<std::string, double>& keys) {
  planning::TermSettings settings;
  settings.name = name;
  for (const auto& [key, value] : keys) {
    if (key == "weight") {
      settings.weight = value;
    } else if (key == "hard") {
      settings.hard = value != 0.0;
    } else {
      settings.parameters.emplace_back(key, value);
    }
  }
  return settings;
}

control::Envelope EnvelopeOf(const Scenario& scenario) {
  const Scenario::Limits& limits = scenario.limits;
  return {limits.speed, limits.acceleration, limits.tilt_deg, scenario.planning.ceiling};
}

double PlanClearance(const Scenario& scenario, const estimation::VehicleModel& model,
                     const Registries& registries) {
  if (!PlannerOf(scenario, registries).proves) return scenario.planning.clearance;
  return std::max(scenario.planning.clearance, control::LeastClearance(model));
}

planning::ReplannerOptions PlannerOptions(const Scenario& scenario,
                                          const estimation::VehicleModel& model,
                                          const planning::TermRegistry& terms) {
  planning::ReplannerOptions options;
  options.backend = scenario.solver.backend;
  options.solver_options.assign(scenario.solver.options.begin(), scenario.solver.options.end());
  planning::Formulation& problem = options.problem;
  problem.terms = terms;
  for (const auto& [name, keys] : scenario.terms) {
    problem.settings.push_back(TermSettingsOf(name, keys));
  }
  problem.endpoint = scenario.solver.endpoint == EndpointKind::kExplicit
                         ? planning::EndpointMode::kExplicit
                         : planning::EndpointMode::kEliminated;
  problem.limits_mode = scenario.solver.limits == LimitsKind::kHard ? planning::LimitsMode::kHard
                                                                    : planning::LimitsMode::kSoft;
  options.arrival = scenario.solver.arrival == ArrivalKind::kFree ? planning::ArrivalMode::kFree
                                                                  : planning::ArrivalMode::kFixed;
  options.max_guides = scenario.planning.guides;
  options.segment_length = scenario.planning.segment_length;
  options.max_work = scenario.planning.max_work;
  options.max_duration = scenario.planning.max_duration;
  options.warm_start = scenario.planning.warm_start;
  options.gap = scenario.solver.gap;
  // With a measured latency, a plan with the longest latency may follow one with the shortest.
  const double period = kClockSteps * sim::WorldConfig{}.timestep + 1.0 / scenario.planning.rate;
  control::SetVehicle(model, EnvelopeOf(scenario), scenario.pad.deck_size, period,
                      scenario.planning.latency.measured ? LongestLatency(scenario) : 0.0,
                      &options);
  if (PlansContact(scenario)) control::SetLanding(&options);
  return options;
}

std::vector<planning::NamedZone> ZonesOf(const planning::ReplannerOptions& options) {
  constexpr int kSegments = 12;  // any number will do
  return planning::LandingProblem(kSegments, planning::ProblemOptions(options, options.arrival))
      .zones();
}

std::unique_ptr<planning::Planner> MakePlanner(const Scenario& scenario,
                                               const estimation::VehicleModel& model,
                                               const Registries& registries) {
  const PlannerEntry& entry = PlannerOf(scenario, registries);
  const PlannerSetup setup{{scenario, entry.parameters},
                           model,
                           registries,
                           EnvelopeOf(scenario).limits(),
                           control::LowestPlan(model),
                           scenario.planning.ceiling};
  return MadeBy(entry, setup, "planner");
}

const PlannerEntry& PlannerOf(const Scenario& scenario, const Registries& registries) {
  return PartNamed(registries.planners, scenario.planner, "planner");
}

double PlannerRate(const Scenario& scenario, const PlannerEntry& planner) {
  return planner.rate > 0.0 ? planner.rate : scenario.planning.rate;
}

double ClosePlannerRate(const Scenario& scenario, const PlannerEntry& planner) {
  const double usual = PlannerRate(scenario, planner);
  if (planner.rate > 0.0 || scenario.planning.latency.measured) return usual;
  // A plan takes over before the next is asked for, on the simulation's clock.
  const double step = sim::WorldConfig{}.timestep;
  const double shortest = step * std::ceil(1e-3 * scenario.planning.latency.ms / step - 1e-6);
  return std::max(usual, 1.0 / std::max(1.0 / kCloseRate, shortest));
}

double LongestLatency(const Scenario& scenario) {
  // Steps are on the simulation's clock. If the period is no multiple of its time step, some steps
  // follow a little faster.
  const double step = sim::WorldConfig{}.timestep;
  return step * std::floor(1.0 / scenario.planning.rate / step + 1e-6);
}

}  // namespace touchdown::evaluation
