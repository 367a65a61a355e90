// SPDX-License-Identifier: BSD-3-Clause
// From a scenario's keys to the planner's options.
#include "evaluation/scenario/planner_options.h"

#include <algorithm>
#include <cmath>

#include "planning/replan/prepared_problems.h"
#include "sim/world/world.h"
#include "touchdown/planning/certify/margins.h"
#include "touchdown/planning/certify/swept_hull.h"

namespace touchdown::evaluation {
namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
constexpr double kTiltReserve_deg = 10.0;  // beyond plans: stops in wind count on it ...
// ... and beyond that, for gusts alone. In gusts of 15 m/s a vehicle 20 % too light is up to 0.9 m off
// its reference without it and 0.2 m with it; more brings no more.
constexpr double kGustReserve_deg = 10.0;
constexpr double kSteepest = 1.3;          // [rad]
constexpr double kFeetAboveGround = 0.3;   // away from the pad [m]
constexpr double kCorridorWeight = 300.0;  // of a planned descent, unless the scenario says so ...
constexpr double kHurry = 100.0;           // ... and of the arrival time in it
constexpr double kCloseRate = 20.0;        // [Hz]
constexpr double kClockSteps = 2.0;        // that a step may come late on the simulation's clock

// Where the scenario gives the term no weight of its own.
void SetWeight(const Scenario& scenario, const char* term, double weight,
               std::vector<planning::TermSettings>* settings) {
  const auto keys = scenario.terms.find(term);
  if (keys != scenario.terms.end() && keys->second.count("weight") != 0) return;
  settings->push_back(TermSettingsOf(term, {{"weight", weight}}));
}

planning::Limits LimitsOf(const Scenario& scenario) {
  const double of_tilt = estimation::kGravity * std::tan(scenario.limits.tilt_deg * kRadPerDeg);
  return {scenario.limits.speed, std::min(scenario.limits.acceleration, of_tilt)};
}

double HullAtEveryTilt(const estimation::VehicleModel& model) {
  return std::hypot(model.hull_radius, model.foot_depth);
}

double TiltBeyondPlans(const Scenario& scenario, double reserve_deg) {
  return std::min(kSteepest, (scenario.limits.tilt_deg + reserve_deg) * kRadPerDeg);
}

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

double TrackingTilt(const Scenario& scenario) {
  return TiltBeyondPlans(scenario, kTiltReserve_deg + kGustReserve_deg);
}

double PlanClearance(const Scenario& scenario, const estimation::VehicleModel& model,
                     const Registries& registries) {
  if (!PlannerOf(scenario, registries).proves) return scenario.planning.clearance;
  const planning::Margins calm = planning::MarginsOf(0.0, 0.0, 0.0, Eigen::Vector3d::Zero());
  const double kept = HullAtEveryTilt(model) + calm.Sum() + planning::kSweepRoom;
  return std::max(scenario.planning.clearance, kept);
}

double LowestPlan(const estimation::VehicleModel& model) {
  return std::max(planning::ReplannerOptions{}.floor_height, model.foot_depth + kFeetAboveGround);
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
  if (PlansContact(scenario)) {
    // The last metres come from above, and the vehicle stands over the deck as the pad's motion asks.
    problem.free_end_acceleration = false;
    SetWeight(scenario, "approach_corridor", kCorridorWeight, &problem.settings);
    if (scenario.solver.arrival == ArrivalKind::kFree) {
      SetWeight(scenario, "arrival_time", kHurry, &problem.settings);
    }
  }
  problem.endpoint = scenario.solver.endpoint == EndpointKind::kExplicit
                         ? planning::EndpointMode::kExplicit
                         : planning::EndpointMode::kEliminated;
  problem.limits_mode = scenario.solver.limits == LimitsKind::kHard ? planning::LimitsMode::kHard
                                                                    : planning::LimitsMode::kSoft;
  problem.vehicle.thrust_max = model.MaxThrust() / model.mass_kg;
  problem.vehicle.thrust_min = 4.0 * model.rotor_thrust_min / model.mass_kg;
  problem.vehicle.tilt_max = scenario.limits.tilt_deg * kRadPerDeg;
  problem.vehicle.stop_tilt_max = TiltBeyondPlans(scenario, kTiltReserve_deg);
  options.arrival = scenario.solver.arrival == ArrivalKind::kFree ? planning::ArrivalMode::kFree
                                                                  : planning::ArrivalMode::kFixed;
  options.limits = LimitsOf(scenario);
  options.ceiling_height = scenario.planning.ceiling;
  options.max_guides = scenario.planning.guides;
  options.segment_length = scenario.planning.segment_length;
  options.max_work = scenario.planning.max_work;
  options.warm_start = scenario.planning.warm_start;
  options.gap = scenario.solver.gap;
  // A plan is flown until the next one takes over, a period later; with a measured latency that may
  // come with the longest after one with the shortest.
  const double period = 1.0 / scenario.planning.rate;
  options.reaction = kClockSteps * sim::WorldConfig{}.timestep + period +
                     (scenario.planning.latency.measured ? LongestLatency(scenario) : 0.0);
  options.floor_height = LowestPlan(model);
  options.contact_height = model.foot_depth;
  options.hull_radius = HullAtEveryTilt(model);
  options.deck_half_size = 0.5 * scenario.pad.deck_size;
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
  const PlannerSetup setup{
      {scenario, entry.parameters}, model, registries, LimitsOf(scenario), LowestPlan(model),
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
  // Steps are taken on the simulation's clock: where the period is no multiple of its time step,
  // some follow each other a little faster.
  const double step = sim::WorldConfig{}.timestep;
  return step * std::floor(1.0 / scenario.planning.rate / step + 1e-6);
}

}  // namespace touchdown::evaluation
