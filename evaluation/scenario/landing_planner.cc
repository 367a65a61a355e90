// SPDX-License-Identifier: BSD-3-Clause
// This project's planner, by a scenario's keys planning.*, solver.* and terms.*.
#include "evaluation/scenario/planner_options.h"

namespace touchdown::evaluation {

PlannerEntry LandingPlanner() {
  PlannerEntry entry;
  entry.name = "landing";
  entry.summary = "moving-endpoint B-spline landing planner";
  entry.lands = entry.proves = true;
  entry.solver = "";
  entry.make = [](const PlannerSetup& setup) {
    return std::make_unique<planning::Replanner>(
        PlannerOptions(setup.scenario, setup.model, setup.registries.terms),
        setup.registries.backends);
  };
  return entry;
}

}  // namespace touchdown::evaluation
