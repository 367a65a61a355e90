// SPDX-License-Identifier: BSD-3-Clause
// Flights of a point through a forest, with perfect tracking. They show a planner that is asked again and again while
// obstacles come into sight, without sensors, controller or physics.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/base/statistics.h"
#include "evaluation/studies/replan/forest_scene.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

/// How a flight ended.
enum class FlightOutcome {
  kReached,   ///< at the goal, nearly at rest
  kCollided,  ///< nearer to an obstacle than kFlightTouch
  kStuck,     ///< out of time
  kCrashed,   ///< the planner threw an exception, or gave a reference that is not finite
};
const char* ToString(FlightOutcome outcome);

/// A point this near to an obstacle has collided [m].
inline constexpr double kFlightTouch = 0.05;

struct ForestFlightOptions {
  SceneKind kind;
  bool ego = false;  ///< the EGO-Planner baseline instead of the landing planner
  planning::ReplannerOptions replanner;  ///< of the landing planner
  std::uint64_t seed = 1;
};

struct ForestFlight {
  int index = 0;
  FlightOutcome outcome = FlightOutcome::kStuck;
  std::string message;                ///< of an exception
  double time = 0.0;                  ///< [s]
  double length = 0.0;                ///< flown [m]
  double clearance = 0.0;             ///< least distance to an obstacle, by FCL [m]
  double max_speed = 0.0;             ///< norm [m/s]
  double max_acceleration = 0.0;      ///< norm [m/s^2]
  int plans = 0;                      ///< replanning steps that made a plan
  int steps = 0;                      ///< of the planner
  std::map<std::string, int> others;  ///< steps that did not, by status and reason
  std::vector<double> step_ms;        ///< thread CPU time of each step that called a solver
};

/// Flies 36 m along x, from rest to rest at 1 m height, through forest number `index` of the kind (40 x 40 x 3 m).
/// Obstacles within 5 m of the point become known at 10 Hz. The landing planner is asked at 10 Hz and answers after 20
/// ms. The baseline's state machine runs at its own 100 Hz and gets its goal once. The same options and index give the
/// same flight except for times.
ForestFlight FlyThroughForest(const ForestFlightOptions& options,
                              const solvers::BackendRegistry& backends, int index);

/// Flights in figures.
struct FlightSummary {
  int flights = 0;
  std::map<FlightOutcome, int> outcomes;
  Interval reached;  ///< share, 95 % Clopper-Pearson
  Quantiles time, length, clearance, max_speed, max_acceleration, plans, step_ms;
  int steps = 0;                 ///< that called a solver
  int failed = 0;                ///< steps without a plan
  double least_clearance = 0.0;  ///< [m]
};
FlightSummary Summarise(const std::vector<ForestFlight>& flights);

}  // namespace touchdown::evaluation
