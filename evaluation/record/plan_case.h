// SPDX-License-Identifier: BSD-3-Clause
// One replanning step, solved and explained.
#pragma once

#include <optional>
#include <string>

#include "evaluation/record/record_reader.h"
#include "evaluation/record/replay.h"
#include "touchdown/planning/replan/replan_log.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {

/// A step without a flight. The vehicle hovers at the scenario's start. The obstacles in the map's window and the pad's
/// future are known. The first plan, to above the pad, is asked for. The recorded result of its only step is empty.
/// @throws BadInput if the scenario cannot be set up.
RecordedFlight StepFromStart(const Scenario& scenario, const Registries& registries);

/// A solved step with all that explains it.
struct SolvedStep {
  std::string source;  ///< in words: where the step comes from
  Scenario scenario;
  int step = 0;
  RecordPlan recorded;                      ///< the question; of a record the answer, too
  std::optional<bool> same;                 ///< as recorded, bit for bit; of a record
  ReplanOutcome outcome;                    ///< of the step solved again
  planning::FlightPair pair;                ///< that is flown from t_start on ...
  bool committed = false;                   ///< ... and was proven in this step
  std::string forbidden_by;  ///< the term or limit that forbade a new plan, if one did
  std::optional<Eigen::Vector3d> unseen_W;  ///< cell that this step's pairs lack, or the next's [m]
  planning::StageTimes times;               ///< without the log
  planning::ReplanLog log;
  planning::Limits limits;
  std::vector<std::string> terms;             ///< of the objective, in the order of the log's costs
  std::vector<planning::NamedZone> zones;     ///< where terms act
  std::vector<estimation::PadState> pad;      ///< predicted over the curve, every kPadStep
  std::vector<planning::CellIndex> occupied;  ///< cells of the map near what was planned
  std::vector<planning::CellCube> prior;      ///< near the flight, what map.prior held occupied
  double resolution = 0.1;                    ///< of the map [m]
  double t_pad = 0.0;                         ///< of the first predicted pad [s]
  static constexpr double kPadStep = 0.1;     ///< [s]
};

/// Solves the step of `flight` to which `replay` was brought: once for its times, once more with a log. Without the
/// map's cells. @throws BadInput if it is the step of another planner than landing.
SolvedStep SolveSought(const RecordedFlight& flight, Replay* replay);

/// Solves step `step` of `flight`, with the map's cells. @throws BadInput as Replay and SolveSought.
SolvedStep SolveStep(const RecordedFlight& flight, int step, const Registries& registries);

}  // namespace touchdown::evaluation
