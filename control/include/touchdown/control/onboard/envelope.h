// SPDX-License-Identifier: BSD-3-Clause
// What follows from a vehicle and its envelope for its planner, its map and its tracking law.
#pragma once

#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/planning/spline/limits.h"

namespace touchdown::control {

/// The hull's radius about the centre of mass, feet and all, however the vehicle tilts [m].
double HullAtEveryTilt(const estimation::VehicleModel& model);

/// Plans stay above this away from the pad [m].
double LowestPlan(const estimation::VehicleModel& model);

/// How far plans stay from obstacles at least: what proven pairs keep in calm air, the hull at every tilt and its
/// margins [m].
double LeastClearance(const estimation::VehicleModel& model);

/// Tells the planner of the vehicle, of its envelope and of how often it is asked. A plan is flown until the next one
/// takes over: a `period` after it is asked for, or later by `late` [s].
void SetVehicle(const estimation::VehicleModel& model, const Envelope& envelope, double deck_size,
                double period, double late, planning::ReplannerOptions* options);

/// Plans come down from above and end as early as is good, with the vehicle over the deck as the pad's motion asks:
/// what `descent: planned` adds. Weights that are set already stay.
void SetLanding(planning::ReplannerOptions* options);

/// An Onboard's options and parts for a vehicle that lands on a pad of this height by a Replanner, with the own state
/// given: what the program uses by default, without its latency. Change options before LandingParts, which takes from
/// them, the envelope too, what planner and law need to know. @throws std::invalid_argument as Replanner does.
OnboardOptions LandingOptions(const estimation::VehicleModel& model, double deck_height,
                              const Envelope& envelope = {});
OnboardParts LandingParts(const OnboardOptions& options);

}  // namespace touchdown::control
