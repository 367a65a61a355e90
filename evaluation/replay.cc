// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/replay.h"

#include <stdexcept>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/perception.h"
#include "touchdown/evaluation/planner_options.h"
#include "touchdown/evaluation/scenario_world.h"
#include "touchdown/sim/vehicle_file.h"

namespace touchdown::evaluation {
namespace {

sim::PadMotion TruthOf(const Scenario& scenario) {
  const TrialDraw draw = DrawTrial(scenario, scenario.seed);
  return sim::PadMotion(PadMotionOf(scenario, draw.phase, draw.seed));
}

estimation::VehicleModel ModelOf(const RecordedFlight& flight) {
  return sim::LoadVehicleModel(VehicleMjcf(flight.scenario));
}

// What a backend or the vehicle's file refuses is the user's to mend.
planning::Replanner MakeReplanner(const RecordedFlight& flight, const Registries& registries) {
  if (flight.scenario.planner != PlannerKind::kLanding) {
    throw BadInput(
        fmt::format("{}: only steps of the planner landing can be asked again.", flight.path));
  }
  try {
    return {PlannerOptions(flight.scenario, ModelOf(flight), registries.terms), registries.backends};
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}: its planner cannot be set up: {}.", flight.path, error.what()));
  }
}

}  // namespace

Replay::Replay(const RecordedFlight& flight, const Registries& registries)
    : flight_(flight),
      oracle_(TruthOf(flight.scenario)),
      replanner_(MakeReplanner(flight, registries)),
      map_(MapOptions(flight.scenario, ModelOf(flight))) {
  replanner_.Prepare(map_);
}

void Replay::Seek(int step) {
  if (step < step_) {
    map_ = planning::OccupancyMap(map_.options());
    step_ = -1;
  }
  while (step_ < step) {
    ++step_;
    Apply(recorded().map_change, &map_);
  }
  const PredictionData& prediction = recorded().request.prediction;
  belief_.reset();
  if (prediction.source == PredictionSource::kBelief) belief_ = prediction.Belief();
}

const estimation::PadPrediction* Replay::prediction() const {
  if (belief_) return &*belief_;
  return recorded().request.prediction.source == PredictionSource::kOracle ? &oracle_ : nullptr;
}

const planning::ReplanResult& Replay::Solve() {
  const RecordPlan& row = recorded();
  replanner_.Restore(row.before);
  planning::ReplanInput input = row.request.input;
  input.pad = prediction();
  return row.request.rest_climb ? replanner_.Rest(input, *row.request.rest_climb, map_)
                                : replanner_.Replan(input, map_);
}

}  // namespace touchdown::evaluation
