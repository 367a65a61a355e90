// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "evaluation/flight/map_history.h"
#include "evaluation/scenario/scenario_world.h"
#include "touchdown/control/onboard/replan_request.h"
#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/map/persistent_map.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {

/// One row of the recorded time series.
struct RecordSample {
  double t = 0.0;
  estimation::VehicleState vehicle;  ///< true
  estimation::VehicleState vehicle_estimate;
  estimation::PadState pad;  ///< true
  bool pad_known = false;
  estimation::PadState pad_estimate;  ///< meaningful if pad_known
  planning::FlatState reference;
  estimation::Commands rotor_thrusts;             ///< of the actuators after their lag [N]
  Eigen::Vector3d air = Eigen::Vector3d::Zero();  ///< true velocity at the vehicle, in W [m/s]
  control::Disturbance disturbance;               ///< as the pilot estimates it
  const char* mode = "";                          ///< of the mission
};

struct RecordEvent {
  double t = 0.0;
  std::string kind;  ///< "mode", "gate", "descent", "own_state", "contact", "outcome"
  std::string text;
};

/// The result of a replanning step; all of it repeats bit by bit.
struct ReplanOutcome {
  planning::ReplanStatus status = planning::ReplanStatus::kHolding;
  planning::ReplanReason reason = planning::ReplanReason::kNone;
  bool from_odometry = false;
  planning::UniformBspline curve;
  planning::Certificate certificate;
  std::vector<std::vector<Eigen::Vector3d>> guide_paths;
  int pairs = 0;
  int solves = 0;
  int rebinds = 0;
  int iterations = 0;
  double cost = 0.0;
  std::vector<solvers::TermCost> cost_by_term;  ///< those that cost anything
  int work = 0;                                 ///< of planning.max_work
};
ReplanOutcome OutcomeOf(const planning::ReplanResult& result);

/// Everything that a record holds is equal. Numbers that are not finite count as equal, and so do
/// zeros of both signs: a file does not distinguish them.
bool Same(const ReplanOutcome& a, const ReplanOutcome& b);

/// One replanning step: its input and its result.
struct RecordPlan {
  control::ReplanRequest request;
  planning::ReplannerState before;  ///< what the replanner remembered
  MapChange map_change;             ///< since the previous replanning step
  estimation::PadState pad;         ///< the prediction at t_now
  ReplanOutcome result;
  double latency_s = 0.0;            ///< with which it was flown
  double wall_s = 0.0, cpu_s = 0.0;  ///< that it took; does not repeat
};

/// What a picture shows of map.prior near the flight.
struct RecordPrior {
  std::vector<planning::CellCube> occupied;  ///< what the prior holds occupied
  std::vector<planning::CellIndex> gone, appeared;
};

/// Everything of one trial that is worth keeping, in memory until it is written at the end.
struct TrialRecord {
  double map_resolution = 0.1;                                 ///< [m]
  planning::CellIndex map_size = planning::CellIndex::Ones();  ///< of the window
  OutsideFiles outside;                               ///< as they were when the flight began
  Eigen::Vector3d hover_W = Eigen::Vector3d::Zero();  ///< that the planner was told at first [m]
  int idle_steps = 0;  ///< in which the planner had nothing to do: they are not among the plans
  std::vector<planning::NamedZone> zones;  ///< of the landing planner's terms
  std::vector<RecordSample> samples;
  std::vector<RecordEvent> events;
  std::vector<RecordPlan> plans;
  RecordPrior prior;
};

}  // namespace touchdown::evaluation
