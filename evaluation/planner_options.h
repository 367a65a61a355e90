// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/vehicle_model.h"
#include "touchdown/evaluation/scenario.h"
#include "touchdown/planning/replanner.h"

namespace touchdown::evaluation {

/// What the replanner is told of a scenario and its vehicle.
planning::ReplannerOptions PlannerOptions(const Scenario& scenario,
                                          const estimation::VehicleModel& model);

/// Longest time from the question to the plan [s]: the least time between two replanning steps. A
/// plan that took over later would still be waiting when the next one is asked for.
double LongestLatency(const Scenario& scenario);

}  // namespace touchdown::evaluation
