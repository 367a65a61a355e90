// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/record/plan_case.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "control/onboard/pilot.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/flight/field_map.h"
#include "evaluation/flight/onboard_setup.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"
#include "touchdown/control/mission/landing_state_machine.h"
#include "touchdown/planning/replan/span_log.h"

namespace touchdown::evaluation {
namespace {

constexpr double kDrawnAround = 3.0;  // occupied cells this near to what was planned [m]

// The target of a flight's first step, in still air: contact, or to follow above the pad.
planning::EndpointTarget FirstTarget(const Scenario& scenario,
                                     const estimation::VehicleModel& model) {
  const control::MissionParameters mission;
  planning::EndpointTarget target;
  if (PlansContact(scenario)) {
    target = control::ContactTarget(model, mission.touchdown_rate, control::kLevelTime);
  } else if (scenario.task == TaskKind::kGoTo) {
    target.height = 0.0;
  } else {
    target.height = target.height_floor = mission.follow_height + model.foot_depth;
  }
  target.at_rest = scenario.planning.endpoint_velocity == EndpointVelocityKind::kRest;
  return target;
}

MapChange KnownObstacles(const Scenario& scenario, const estimation::VehicleModel& model,
                         const TrialDraw& draw, const Registries& registries) {
  planning::OccupancyMap map(MapOptions(scenario, model, registries));
  map.Recentre(draw.p_WB);
  std::vector<sim::Obstacle> obstacles;
  for (NamedObstacle& named : ObstaclesOf(scenario)) obstacles.push_back(named.obstacle);
  FillMap(sim::ObstacleField(std::move(obstacles)), &map);
  return MapRecorder().Take(map);
}

// The occupied cells in the box around all curves and guide paths of the step.
std::vector<planning::CellIndex> CellsNear(const SolvedStep& solved,
                                           const planning::OccupancyMap& map) {
  Eigen::Vector3d low = solved.recorded.request.input.vehicle.p_WB;
  Eigen::Vector3d high = low;
  const auto hold = [&](const Eigen::Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  const auto hold_curve = [&](const planning::UniformBspline& curve) {
    for (int i = 0; i < curve.control_points().cols(); ++i) hold(curve.control_points().col(i));
  };
  hold_curve(solved.outcome.curve);
  hold_curve(solved.recorded.before.next.curve);
  for (const auto& path : solved.outcome.guide_paths) {
    for (const Eigen::Vector3d& p : path) hold(p);
  }
  for (const estimation::PadState& pad : solved.pad) hold(pad.p_WP);
  const planning::CellIndex first = map.CellOf(low.array() - kDrawnAround).cwiseMax(map.origin());
  const planning::CellIndex last =
      map.CellOf(high.array() + kDrawnAround)
          .cwiseMin(map.origin() + map.size() - planning::CellIndex::Ones());
  std::vector<planning::CellIndex> cells;
  planning::CellIndex cell;
  for (cell.z() = first.z(); cell.z() <= last.z(); ++cell.z()) {
    for (cell.y() = first.y(); cell.y() <= last.y(); ++cell.y()) {
      for (cell.x() = first.x(); cell.x() <= last.x(); ++cell.x()) {
        if (map.IsOccupied(cell)) cells.push_back(cell);
      }
    }
  }
  return cells;
}

}  // namespace

RecordedFlight StepFromStart(const Scenario& scenario, const Registries& registries) {
  try {
    const TrialDraw draw = DrawTrial(scenario, scenario.seed);
    const estimation::VehicleModel model = sim::LoadVehicleModel(VehicleMjcf(scenario));
    if (!PlannerOf(scenario, registries).solver.empty()) {
      throw BadInput(
          fmt::format("{}: only plans of the planner landing are explained, not those of {}.",
                      scenario.name, scenario.planner));
    }
    planning::Replanner replanner(PlannerOptions(scenario, model, registries.terms),
                                  registries.backends);
    replanner.CommitHover(draw.p_WB, 0.0);
    RecordedFlight flight;
    flight.path = scenario.name;
    flight.scenario = scenario;
    flight.scenario.pad.prediction = "oracle";
    RecordPlan& plan = flight.plans.emplace_back();
    plan.before = replanner.state();
    plan.map_change = KnownObstacles(scenario, model, draw, registries);
    planning::ReplanInput& input = plan.request.input;
    input.t_start = scenario.planning.latency.measured ? LongestLatency(scenario)
                                                       : 1e-3 * scenario.planning.latency.ms;
    input.vehicle.p_WB = draw.p_WB;
    input.vehicle.q_WB = Eigen::AngleAxisd(draw.yaw, Eigen::Vector3d::UnitZ());
    input.endpoint = FirstTarget(scenario, model);
    plan.request.pad.emplace();
    return flight;
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}: no plan can be asked for: {}.", scenario.name, error.what()));
  }
}

SolvedStep SolveSought(const RecordedFlight& flight, Replay* replay) {
  SolvedStep solved;
  solved.scenario = flight.scenario;
  solved.step = replay->step();
  solved.recorded = replay->recorded();
  if (replay->replanner() == nullptr) {
    throw BadInput(fmt::format("{}: only plans of the planner landing are explained, not those of {}.",
                               flight.path, flight.scenario.planner));
  }
  const planning::ReplannerOptions& options = replay->replanner()->options();
  solved.limits = planning::LimitsUnder(options.limits, options.problem.vehicle,
                                        solved.recorded.request.input.pull_W);
  {
    planning::SpanLog unkept;  // asks for the CPU time of the stages
    const planning::SpanLog::Listening listening(&unkept);
    solved.times = replay->Solve().times;
  }
  replay->replanner()->set_log(&solved.log);
  const planning::ReplanResult& result = replay->Solve();
  replay->replanner()->set_log(nullptr);
  solved.outcome = OutcomeOf(result);
  solved.pair = result.pair();
  solved.committed = result.committed;
  solved.forbidden_by = std::string(result.forbidden_by);
  solved.unseen_W = result.unseen_W;
  for (const solvers::TermCost& term : result.solver.cost_by_term)
    solved.terms.push_back(term.name);
  solved.zones = ZonesOf(options);
  solved.resolution = replay->map().resolution();
  if (const estimation::PadPrediction* prediction = replay->prediction()) {
    solved.t_pad = solved.recorded.request.input.t_now;
    const double end = std::max(solved.outcome.curve.t_end(), solved.t_pad);
    for (int i = 0; solved.t_pad + i * SolvedStep::kPadStep <= end; ++i) {
      solved.pad.push_back(prediction->At(solved.t_pad + i * SolvedStep::kPadStep));
    }
  }
  return solved;
}

SolvedStep SolveStep(const RecordedFlight& flight, int step, const Registries& registries) {
  Replay replay(flight, registries);
  replay.Seek(step);
  replay.Solve();  // the first time finds cold caches
  SolvedStep solved = SolveSought(flight, &replay);
  solved.occupied = CellsNear(solved, replay.map());
  solved.prior = flight.prior;
  return solved;
}

}  // namespace touchdown::evaluation
