// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/forest_flight.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/flight/field_map.h"
#include "evaluation/studies/replan/replan_scene.h"
#include "planning/baselines/ego/ego_planner.h"
#include "sim/obstacles/forest.h"
#include "sim/obstacles/true_clearance.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {
namespace {

using Eigen::Vector3d;
using planning::OccupancyMap;

constexpr double kDistance = 36.0;  // start to goal [m]
constexpr double kHeight = 1.0;     // of both [m]
constexpr double kLane = 12.0;  // largest distance of the straight way from the forest's middle [m]
constexpr double kKeepOut = 2.0;     // of pillars around start and goal [m]
constexpr double kSeen = 5.0;        // [m]
constexpr double kSeenPeriod = 0.1;  // [s]
constexpr double kTick = 0.005;      // of the flight [s]
constexpr double kPeriod = 0.1;      // of the landing planner [s]
constexpr double kLatency = 0.02;    // of its answers [s]
constexpr double kGoalRadius = 0.3;  // from the goal [m] ...
constexpr double kSlow = 0.2;        // ... at most this fast [m/s]
constexpr double kTimeout = 120.0;   // [s]
constexpr int kDraws = 100;

/// The forest, all of it known; start and goal are free in it.
struct Course {
  sim::ObstacleField field;
  std::unique_ptr<OccupancyMap> truth;
  Vector3d start, goal;
};

std::unique_ptr<OccupancyMap> MakeMap(const SceneKind& kind, const Eigen::Vector3i& size_log2) {
  planning::OccupancyMapOptions options;
  options.inflation_radius = kind.inflation;
  options.size_log2 = size_log2;
  return std::make_unique<OccupancyMap>(options);
}

Course DrawCourse(const ForestFlightOptions& options, int index) {
  for (int draw = 0; draw < kDraws; ++draw) {
    sim::RandomStream stream(options.seed, fmt::format("forest flight {} {}", index, draw));
    const double y = stream.Uniform(-kLane, kLane);
    Course course;
    course.start = {-0.5 * kDistance, y, kHeight};
    course.goal = {0.5 * kDistance, y, kHeight};
    sim::ForestConfig forest = sim::ForestOfKind(options.kind.forest);
    forest.keep_out = {{course.start.head<2>(), kKeepOut}, {course.goal.head<2>(), kKeepOut}};
    course.field = sim::MakeForest(forest, stream.Seed());
    course.truth = MakeMap(options.kind, {9, 9, 5});
    course.truth->Recentre({0.0, 0.0, 0.5 * forest.height});
    FillMap(course.field, course.truth.get());
    if (!course.truth->IsBlocked(course.start) && !course.truth->IsBlocked(course.goal)) {
      return course;
    }
  }
  throw std::runtime_error(
      fmt::format("forest flight {}: start or goal was blocked in {} draws", index, kDraws));
}

/// Every cell within sight is known from now on.
void Look(const Vector3d& p_W, const OccupancyMap& truth, OccupancyMap* map) {
  map->Recentre({p_W.x(), p_W.y(), kHeight});
  const planning::CellBox box = {map->CellOf(p_W.array() - kSeen),
                                 map->CellOf(p_W.array() + kSeen)};
  planning::ForEachCell(box, [&](const planning::CellIndex& cell) {
    if (!map->InWindow(cell) || map->IsKnown(cell)) return;
    if ((map->CentreOf(cell) - p_W).squaredNorm() > kSeen * kSeen) return;
    map->SetState(
        cell, truth.IsOccupied(cell) ? planning::CellState::kOccupied : planning::CellState::kFree);
  });
}

std::unique_ptr<planning::Planner> MakePlanner(const ForestFlightOptions& options,
                                               const solvers::BackendRegistry& backends) {
  const planning::Limits& limits = options.kind.limits;
  if (options.ego) {
    planning::EgoPlannerOptions ego;
    ego.plan.max_speed = limits.speed;
    ego.plan.max_acceleration = limits.acceleration;
    ego.goal_rate = 1.0 / (2.0 * kTimeout);  // once
    ego.floor_height = kForestFloor;
    ego.ceiling_height = kForestCeiling;
    return std::make_unique<planning::EgoPlanner>(ego);
  }
  SceneOptions scene;
  scene.kind = options.kind;
  planning::ReplannerOptions landing = SceneReplannerOptions(scene, options.replanner);
  landing.max_duration = kTimeout;
  landing.reaction = kPeriod + kLatency;
  return std::make_unique<planning::Replanner>(landing, backends);
}

/// The flight under way.
class Flight {
 public:
  Flight(const ForestFlightOptions& options, const solvers::BackendRegistry& backends, int index)
      : course_(DrawCourse(options, index)),
        map_(MakeMap(options.kind, {8, 8, 5})),
        planner_(MakePlanner(options, backends)),
        end_(course_.goal, Vector3d::Zero(), 0.0),
        ego_(options.ego),
        truth_(course_.field, PointVehicle()) {
    flight_.index = index;
    flight_.clearance = std::numeric_limits<double>::infinity();
  }

  ForestFlight Run() {
    planner_->Prepare(*map_);
    planner_->CommitHover(course_.start, 0.0);
    last_ = course_.start;
    try {
      for (long tick = 0; !over_; ++tick) Step(tick);
    } catch (const std::exception& error) {
      flight_.outcome = FlightOutcome::kCrashed;
      flight_.message = error.what();
    }
    return flight_;
  }

 private:
  void End(FlightOutcome outcome) {
    flight_.outcome = outcome;
    over_ = true;
  }

  void Step(long tick) {
    const double t = static_cast<double>(tick) * kTick;
    const planning::FlatState at = planner_->Reference(t);
    if (!at.p_WB.allFinite() || !at.v_WB.allFinite()) return End(FlightOutcome::kCrashed);
    Measure(at, t);
    if (over_) return;
    const auto every = [tick](double period) { return tick % std::lround(period / kTick) == 0; };
    if (every(kSeenPeriod)) Look(at.p_WB, *course_.truth, map_.get());
    if (every(ego_ ? 1.0 / planning::EgoPlanner::kRate : kPeriod)) Replan(at, t);
  }

  void Measure(const planning::FlatState& at, double t) {
    estimation::VehicleState vehicle;
    vehicle.p_WB = at.p_WB;
    flight_.time = t;
    flight_.length += (at.p_WB - last_).norm();
    last_ = at.p_WB;
    flight_.clearance = std::min(flight_.clearance, truth_.Distance(vehicle));
    flight_.max_speed = std::max(flight_.max_speed, at.v_WB.norm());
    flight_.max_acceleration = std::max(flight_.max_acceleration, at.a_WB.norm());
    if (flight_.clearance < kFlightTouch) return End(FlightOutcome::kCollided);
    const bool there = (at.p_WB - course_.goal).norm() < kGoalRadius && at.v_WB.norm() < kSlow;
    if (there) return End(FlightOutcome::kReached);
    if (t >= kTimeout) End(FlightOutcome::kStuck);
  }

  void Replan(const planning::FlatState& at, double t) {
    planning::ReplanInput input;
    input.t_now = t;
    input.t_start = ego_ ? t : t + kLatency;
    input.vehicle.t = t;
    input.vehicle.p_WB = at.p_WB;
    input.vehicle.v_WB = at.v_WB;
    input.pad = &end_;
    input.endpoint.height = 0.0;
    const planning::ReplanResult& result = planner_->Replan(input, *map_);
    const bool planned = result.status == planning::ReplanStatus::kPlanned;
    ++flight_.steps;
    if (result.solves > 0) flight_.step_ms.push_back(1e3 * result.times.total.cpu);
    if (planned) {
      ++flight_.plans;
    } else if (!ego_ || result.reason != planning::ReplanReason::kNone) {
      ++flight_.others[fmt::format("{}, {}", planning::ToString(result.status),
                                   planning::ToString(result.reason))];
    }
  }

  Course course_;
  std::unique_ptr<OccupancyMap> map_;
  std::unique_ptr<planning::Planner> planner_;
  MovingTarget end_;
  bool ego_;
  sim::TrueClearance truth_;
  Vector3d last_ = Vector3d::Zero();
  bool over_ = false;
  ForestFlight flight_;
};

}  // namespace

const char* ToString(FlightOutcome outcome) {
  switch (outcome) {
    case FlightOutcome::kReached:
      return "reached";
    case FlightOutcome::kCollided:
      return "collided";
    case FlightOutcome::kStuck:
      return "stuck";
    case FlightOutcome::kCrashed:
      return "crashed";
  }
  return "?";
}

ForestFlight FlyThroughForest(const ForestFlightOptions& options,
                              const solvers::BackendRegistry& backends, int index) {
  return Flight(options, backends, index).Run();
}

FlightSummary Summarise(const std::vector<ForestFlight>& flights) {
  FlightSummary summary;
  summary.flights = static_cast<int>(flights.size());
  summary.least_clearance = std::numeric_limits<double>::infinity();
  std::vector<double> time, length, clearance, speed, acceleration, plans, step_ms;
  for (const ForestFlight& flight : flights) {
    ++summary.outcomes[flight.outcome];
    summary.least_clearance = std::min(summary.least_clearance, flight.clearance);
    clearance.push_back(flight.clearance);
    speed.push_back(flight.max_speed);
    acceleration.push_back(flight.max_acceleration);
    plans.push_back(flight.plans);
    step_ms.insert(step_ms.end(), flight.step_ms.begin(), flight.step_ms.end());
    for (const auto& [what, count] : flight.others) summary.failed += count;
    summary.steps += flight.steps;
    // A flight that does not arrive takes for ever.
    const bool arrived = flight.outcome == FlightOutcome::kReached;
    time.push_back(arrived ? flight.time : std::numeric_limits<double>::infinity());
    if (arrived) length.push_back(flight.length);
  }
  if (!flights.empty()) {
    summary.reached = ClopperPearson(summary.outcomes[FlightOutcome::kReached], summary.flights);
  }
  summary.time = QuantilesOf(time);
  summary.length = QuantilesOf(length);
  summary.clearance = QuantilesOf(clearance);
  summary.max_speed = QuantilesOf(speed);
  summary.max_acceleration = QuantilesOf(acceleration);
  summary.plans = QuantilesOf(plans);
  summary.step_ms = QuantilesOf(step_ms);
  return summary;
}

}  // namespace touchdown::evaluation
