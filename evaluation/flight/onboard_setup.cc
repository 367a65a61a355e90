// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/onboard_setup.h"

#include <algorithm>
#include <utility>

#include "evaluation/base/map_file.h"
#include "evaluation/flight/own_sense.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {
namespace {

// With an estimated own state; docs/own_state.md gives their source.
constexpr double kOwnPositionSigma = 0.01;  // what the estimate jumps by between images [m]
constexpr double kOwnAttitudeSigma = 0.01;  // [rad]
constexpr double kFrameWander = 1e-3;       // 0.03 m/s that last for about a second [m^2/s]
constexpr double kHistory = 0.5;            // of given states, beyond the latest image [s]

control::DescentStyle StyleOf(const Scenario& scenario) {
  if (scenario.task != TaskKind::kLand) return control::DescentStyle::kNone;
  return PlansContact(scenario) ? control::DescentStyle::kPlanned
                                : control::DescentStyle::kVertical;
}

control::ControllerOptions TrackingOptions(const Scenario& scenario,
                                           const estimation::VehicleModel& model) {
  control::ControllerOptions options = control::OptionsFor(model);
  options.tilt_max = EnvelopeOf(scenario).TrackingTilt();
  return options;
}

const ControllerEntry& LawOf(const Scenario& scenario, const Registries& registries) {
  return PartNamed(registries.controllers, scenario.controller, "controller");
}

control::OnboardOptions OptionsOf(const Scenario& scenario, const estimation::VehicleModel& model,
                                  const Registries& registries) {
  const PlannerEntry& planner = PlannerOf(scenario, registries);
  control::OnboardOptions options;
  options.model = model;
  options.envelope = EnvelopeOf(scenario);
  options.descent = StyleOf(scenario);
  options.to_goal = scenario.task == TaskKind::kGoTo;
  options.end_at_rest = scenario.planning.endpoint_velocity == EndpointVelocityKind::kRest;
  options.deck_size = scenario.pad.deck_size;
  options.corridor_radius = scenario.mission.corridor_radius;
  options.replan_rate = PlannerRate(scenario, planner);
  options.close_rate = ClosePlannerRate(scenario, planner);
  options.latency.time = 1e-3 * scenario.planning.latency.ms;
  options.latency.measured = scenario.planning.latency.measured;
  options.latency.longest = LongestLatency(scenario);
  options.shortest_contact_plan =
      PlannerOptions(scenario, model, registries.terms).min_contact_duration;
  options.estimate_disturbance = scenario.control.disturbance;
  if (scenario.own_state == OwnStateKind::kEstimated) {
    const sim::OwnSensorRigConfig sensors = OwnSensorsOf(scenario);
    options.own_state = sim::FilterOptionsFor(sensors);
    options.own_clock_ahead = sensors.hover_before;
  }
  options.history =
      kHistory + 1e-3 * std::max(scenario.camera.latency_ms, scenario.depth.latency_ms);
  options.pad = PadFilterOptionsOf(scenario);
  options.map = MapOptions(scenario, model, registries);
  options.start_free = scenario.map_start_free;
  return options;
}

}  // namespace

estimation::PadFilterOptions PadFilterOptionsOf(const Scenario& scenario) {
  estimation::PadFilterOptions options;
  options.model = scenario.pad_estimator == PadEstimatorKind::kPaper
                      ? estimation::PadModel::kPaper
                      : estimation::PadModel::kTurnRate;
  options.pad_height = scenario.pad.deck_height;
  options.speed_prior = std::max(options.speed_prior, EnvelopeOf(scenario).PadSpeedPrior());
  if (scenario.own_state == OwnStateKind::kEstimated) {
    options.own_position_sigma = kOwnPositionSigma;
    options.own_attitude_sigma = kOwnAttitudeSigma;
    options.noise.position += kFrameWander;
  }
  return options;
}

planning::OccupancyMapOptions MapOptions(const Scenario& scenario,
                                         const estimation::VehicleModel& model,
                                         const Registries& registries) {
  planning::OccupancyMapOptions options;
  options.inflation_radius = PlanClearance(scenario, model, registries);
  options.range_noise = scenario.depth.noise;
  options.thinnest_obstacle = scenario.map_thinnest_obstacle;
  return options;
}

control::Onboard MakeOnboard(const Scenario& scenario, const estimation::VehicleModel& model,
                             std::shared_ptr<const sim::PadCourse> truth,
                             const Registries& registries) {
  const PlannerEntry& planner = PlannerOf(scenario, registries);
  const ControllerEntry& law = LawOf(scenario, registries);
  control::OnboardOptions options = OptionsOf(scenario, model, registries);
  control::OnboardParts parts;
  parts.planner = MakePlanner(scenario, model, registries);
  parts.planner_lands = planner.lands;
  if (planner.proves) {
    parts.scout =
        std::make_unique<planning::Scout>(PlannerOptions(scenario, model, registries.terms));
  }
  const ControllerSetup setup{{scenario, law.parameters}, model, TrackingOptions(scenario, model)};
  parts.controller = MadeBy(law, setup, "controller");
  parts.law_compensates = law.compensates;
  parts.predictor = PredictorOf(scenario, registries, std::move(truth));
  if (scenario.map_prior != "none") {
    parts.memory.emplace(options.map);
    ReadMapFile(scenario.map_prior, &*parts.memory);
  }
  return control::Onboard(std::move(options), std::move(parts));
}

}  // namespace touchdown::evaluation
