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

/// Least clearance of plans from obstacles [m]: the clearance of proven flight pairs in calm air, the hull
/// at every tilt and its margins.
double LeastClearance(const estimation::VehicleModel& model);

/// Sets the planner's options from the vehicle, its envelope and the planning period. A plan is
/// flown until the next one takes over: a `period` after it is asked for, or later by `late` [s].
void SetVehicle(const estimation::VehicleModel& model, const Envelope& envelope, double deck_size,
                double period, double late, planning::ReplannerOptions* options);

/// What `descent: planned` adds. Plans descend from above and end as early as is useful, over the
/// deck with the pad's velocity. Weights that are set already stay.
void SetLanding(planning::ReplannerOptions* options);

/// Options and parts of an Onboard for a vehicle that lands on a pad of this height by a Replanner,
/// with the own state given. They are the program's defaults, without its latency. Change options
/// before LandingParts, which reads from them, and from the envelope, the planner's and the law's
/// options. @throws std::invalid_argument as Replanner does.
OnboardOptions LandingOptions(const estimation::VehicleModel& model, double deck_height,
                              const Envelope& envelope = {});
OnboardParts LandingParts(const OnboardOptions& options);

}  // namespace touchdown::control
