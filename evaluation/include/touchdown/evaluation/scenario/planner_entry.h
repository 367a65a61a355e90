// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "touchdown/evaluation/scenario/part.h"
#include "touchdown/planning/replan/planner.h"
#include "touchdown/planning/spline/limits.h"

namespace touchdown::evaluation {

/// What a planner is made from.
struct PlannerSetup : PartSetup {
  const estimation::VehicleModel& model;
  const Registries& registries;
  planning::Limits limits;      ///< of the scenario: speed, and acceleration as its tilt allows it
  double floor_height = 0.0;    ///< plans keep the body's origin above this away from the pad [m]
  double ceiling_height = 0.0;  ///< and below this [m]
};

/// How a planner gets into the program (docs/adding_a_planner.md).
struct PlannerEntry : Part {
  bool lands = false;   ///< its plans may end in contact: it takes `descent: planned`
  bool proves = false;  ///< it flies proven flight pairs (docs/safety.md), and is watched as such
  bool avoids = true;   ///< it keeps clear of the map, which is grown by the hull at least
  double rate = 0.0;    ///< at which it is asked [Hz]; 0: planning.rate
  std::string solver =
      "none";  ///< its own, which results name; empty: it has the choice, solver.backend
  std::function<std::unique_ptr<planning::Planner>(const PlannerSetup&)> make;
};

/// The planners of the library, from evaluation/scenario/planners.def.
std::vector<PlannerEntry> StandardPlanners();

}  // namespace touchdown::evaluation
