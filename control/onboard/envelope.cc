// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/control/onboard/envelope.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "estimation/base/degrees.h"
#include "touchdown/planning/certify/margins.h"
#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::control {
namespace {

constexpr double kTiltReserve_deg = 10.0;  // beyond plans: stops in wind count on it ...
// ... and beyond that, for gusts alone. In gusts of 15 m/s a vehicle 20 % too light is up to 0.9 m
// off its reference without it and 0.2 m with it. A larger reserve does not help.
constexpr double kGustReserve_deg = 10.0;
constexpr double kSteepest = 1.3;             // [rad]
constexpr double kFeetAboveGround = 0.3;      // away from the pad [m]
constexpr double kCorridorWeight = 300.0;     // of a planned landing ...
constexpr double kArrivalTimeWeight = 100.0;  // ... and of the arrival time in it
constexpr double kSpeedPrior = 0.5;           // of the pad, share of the speed limit

double Beyond(const Envelope& envelope, double reserve_deg) {
  return std::min(kSteepest, (envelope.tilt_deg + reserve_deg) * estimation::kRadPerDeg);
}

// Where no weight is set.
void SetWeight(const char* term, double weight, planning::ReplannerOptions* options) {
  auto& settings = options->problem.settings;
  const bool given = std::any_of(settings.begin(), settings.end(), [&](const auto& setting) {
    return setting.name == term && setting.weight.has_value();
  });
  if (given) return;
  planning::TermSettings setting;
  setting.name = term;
  setting.weight = weight;
  settings.push_back(setting);
}

}  // namespace

planning::Limits Envelope::limits() const {
  return {speed, std::min(acceleration,
                          estimation::kGravity * std::tan(tilt_deg * estimation::kRadPerDeg))};
}

double Envelope::StopTilt() const { return Beyond(*this, kTiltReserve_deg); }

double Envelope::PadSpeedPrior() const { return kSpeedPrior * speed; }

double Envelope::TrackingTilt() const { return Beyond(*this, kTiltReserve_deg + kGustReserve_deg); }

double HullAtEveryTilt(const estimation::VehicleModel& model) {
  return std::hypot(model.hull_radius, model.foot_depth);
}

double LowestPlan(const estimation::VehicleModel& model) {
  return std::max(planning::ReplannerOptions{}.floor_height, model.foot_depth + kFeetAboveGround);
}

double LeastClearance(const estimation::VehicleModel& model) {
  const planning::Margins calm = planning::MarginsOf(0.0, 0.0, 0.0, 0.0);
  return HullAtEveryTilt(model) + calm.Sum() + planning::kSweepRoom;
}

void SetVehicle(const estimation::VehicleModel& model, const Envelope& envelope, double deck_size,
                double period, double late, planning::ReplannerOptions* options) {
  const estimation::Allocation allocation = estimation::AllocationOf(model);
  options->problem.vehicle.thrust_max = allocation.thrust_max / model.mass_kg;
  options->problem.vehicle.thrust_min = allocation.thrust_min / model.mass_kg;
  options->problem.vehicle.tilt_max = envelope.tilt_deg * estimation::kRadPerDeg;
  options->problem.vehicle.stop_tilt_max = envelope.StopTilt();
  options->limits = envelope.limits();
  options->ceiling_height = envelope.ceiling;
  options->reaction = period + late;
  options->floor_height = LowestPlan(model);
  options->contact_height = model.foot_depth;
  options->hull_radius = HullAtEveryTilt(model);
  options->deck_half_size = 0.5 * deck_size;
}

void SetLanding(planning::ReplannerOptions* options) {
  options->problem.free_end_acceleration = false;
  SetWeight("approach_corridor", kCorridorWeight, options);
  if (options->arrival == planning::ArrivalMode::kFree)
    SetWeight("arrival_time", kArrivalTimeWeight, options);
}

OnboardOptions LandingOptions(const estimation::VehicleModel& model, double deck_height,
                              const Envelope& envelope) {
  OnboardOptions options;
  options.model = model;
  options.envelope = envelope;
  options.pad.pad_height = deck_height;
  options.pad.speed_prior = std::max(options.pad.speed_prior, envelope.PadSpeedPrior());
  options.shortest_contact_plan = planning::ReplannerOptions{}.min_contact_duration;
  options.map.inflation_radius = LeastClearance(model);
  return options;
}

OnboardParts LandingParts(const OnboardOptions& options) {
  planning::ReplannerOptions planner;
  planner.arrival = planning::ArrivalMode::kFree;
  planner.min_contact_duration = options.shortest_contact_plan;
  SetVehicle(options.model, options.envelope, options.deck_size, 1.0 / options.replan_rate,
             options.latency.measured ? options.latency.longest : 0.0, &planner);
  SetLanding(&planner);
  ControllerOptions law = OptionsFor(options.model);
  law.tilt_max = options.envelope.TrackingTilt();
  OnboardParts parts;
  parts.planner = std::make_unique<planning::Replanner>(planner, solvers::StandardBackends());
  parts.scout = std::make_unique<planning::Scout>(planner);
  parts.controller = MakeController("geometric", options.model, law);
  parts.predictor = std::make_unique<estimation::BeliefPredictor>();
  return parts;
}

}  // namespace touchdown::control
