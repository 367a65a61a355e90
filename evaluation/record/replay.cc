// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/record/replay.h"

#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/onboard_setup.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::evaluation {
namespace {

// What a backend or the vehicle's file refuses is a user error.
template <class Make>
auto Made(const RecordedFlight& flight, Make&& make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}: its planner cannot be set up: {}.", flight.path, error.what()));
  }
}

// Not recorded are steps in which a planner has nothing to do, and the time when a late measured answer took over.
void RequireAllSteps(const RecordedFlight& flight, const Registries& registries) {
  const Scenario& scenario = flight.scenario;
  const PlannerEntry& entry = PlannerOf(scenario, registries);
  if (flight.idle_steps == 0 && !scenario.planning.latency.measured) return;
  throw BadInput(fmt::format(
      "{}: the steps of the planner {} cannot be asked again: {}.", flight.path, entry.name,
      flight.idle_steps > 0
          ? "in some it had nothing to do, and these are not recorded"
          : "planning.latency was measured, which only the planner landing remembers"));
}

}  // namespace

Replay::Replay(const RecordedFlight& flight, const Registries& registries)
    : flight_(flight),
      registries_(registries),
      model_(Made(flight, [&] { return sim::LoadVehicleModel(VehicleMjcf(flight.scenario)); })),
      predictor_(Made(flight,
                      [&] {
                        const TrialDraw draw = DrawTrial(flight.scenario, flight.scenario.seed);
                        return PredictorOf(
                            flight.scenario, registries,
                            PadCourseOf(flight.scenario, registries, draw.phase, draw.seed));
                      })),
      planner_(Made(flight, [&] { return MakePlanner(flight.scenario, model_, registries); })),
      replanner_(dynamic_cast<planning::Replanner*>(planner_.get())),
      map_(MapOptions(flight.scenario, model_, registries)) {
  if (replanner_ == nullptr) RequireAllSteps(flight, registries);
  Rewind();
}

// To before the first step.
void Replay::Rewind() {
  map_ = planning::OccupancyMap(map_.options());
  step_ = -1;
  asked_ = true;
  if (replanner_ == nullptr) {
    planner_ = MakePlanner(flight_.scenario, model_, registries_);
  }
  planner_->Prepare(map_);
  if (replanner_ == nullptr) planner_->CommitHover(flight_.hover_W, 0.0);
}

void Replay::Seek(int step) {
  if (step < step_ || (step == step_ && asked_ && replanner_ == nullptr)) Rewind();
  while (step_ < step) {
    if (replanner_ == nullptr && !asked_) Ask();
    ++step_;
    asked_ = false;
    Apply(recorded().map_change, &map_);
  }
}

const estimation::PadPrediction* Replay::prediction() {
  const std::optional<estimation::PadKnowledge>& known = recorded().request.pad;
  return known ? &predictor_->Predict(*known) : nullptr;
}

const planning::ReplanResult& Replay::Solve() {
  if (replanner_ != nullptr) {
    replanner_->Restore(recorded().before);
  } else {
    Seek(step_);
  }
  return Ask();
}

const planning::ReplanResult& Replay::Ask() {
  const RecordPlan& row = recorded();
  asked_ = true;
  planning::ReplanInput input = row.request.input;
  input.pad = prediction();
  return row.request.rest_climb ? planner_->Rest(input, *row.request.rest_climb, map_)
                                : planner_->Replan(input, map_);
}

}  // namespace touchdown::evaluation
