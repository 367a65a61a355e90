// SPDX-License-Identifier: BSD-3-Clause
// What a vehicle may do in flight, and what follows from that for its planner, its map and its tracking law.
#pragma once

#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/planning/spline/limits.h"

namespace touchdown::control {

/// Of plans: the tracking law may use more.
struct Envelope {
  double speed = 3.0;         ///< [m/s]
  double acceleration = 6.0;  ///< [m/s^2]
  double tilt_deg = 35.0;     ///< [deg]
  double ceiling = 10.0;      ///< the body's origin stays below this [m]

  /// Speed, and acceleration as the tilt allows it.
  planning::Limits limits() const;
  /// Of stops: gusts and steady wind are not to be paid for by the way to rest [rad].
  double StopTilt() const;
  /// 1 sigma of the pad's velocity before it is measured [m/s]: a pad may be nearly as fast as the vehicle, and a
  /// narrow prior would gate its first fixes for ever.
  double PadSpeedPrior() const;
  /// Of the tracking law [rad].
  double TrackingTilt() const;
};

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
/// them what planner and law need to know. @throws std::invalid_argument as Replanner does.
OnboardOptions LandingOptions(const estimation::VehicleModel& model, double deck_height,
                              const Envelope& envelope = {});
OnboardParts LandingParts(const OnboardOptions& options, const Envelope& envelope = {});

}  // namespace touchdown::control
