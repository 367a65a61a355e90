// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/evaluation/scenario/controller_entry.h"
#include "touchdown/evaluation/scenario/pad_motion_entry.h"
#include "touchdown/evaluation/scenario/planner_entry.h"
#include "touchdown/evaluation/scenario/predictor_entry.h"
#include "touchdown/planning/problem/term_registry.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

/// What the program offers. An out-of-tree project adds its own entries and gets every sub-command.
struct Registries {
  solvers::BackendRegistry backends;
  planning::TermRegistry terms;
  std::vector<PlannerEntry> planners;
  std::vector<PadMotionEntry> pad_motions;
  std::vector<ControllerEntry> controllers;
  std::vector<PredictorEntry> predictors;
};

/// What the library ships.
Registries StandardRegistries();

/// The parameters of all parts, each once.
std::vector<Parameter> ParametersOf(const Registries& registries);

/// Names are words and distinct. Every part has a `make`. A planner's rate is finite and >= 0. A parameter's key is
/// none of the program's. Its default is in its range. Both are the same in all parts that share the key.
/// @throws std::invalid_argument naming the first entry that breaks a rule.
void RequireDistinct(const Registries& registries);

}  // namespace touchdown::evaluation
