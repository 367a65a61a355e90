// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/evaluation/scenario/controller_entry.h"
#include "touchdown/evaluation/scenario/pad_motion_entry.h"
#include "touchdown/evaluation/scenario/planner_entry.h"
#include "touchdown/evaluation/scenario/predictor_entry.h"
#include "touchdown/planning/problem/term_registry.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

/// What the program offers: an out-of-tree project adds its own entries and has every sub-command.
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

/// Throws std::invalid_argument naming what stands twice, a part that nothing can be made from, and a parameter whose key
/// is one of the program's or is not the same in two parts.
void RequireDistinct(const Registries& registries);

}  // namespace touchdown::evaluation
