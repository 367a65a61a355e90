// SPDX-License-Identifier: BSD-3-Clause
// The options of an Onboard, set before it flies.
#pragma once

#include <memory>
#include <optional>

#include "touchdown/control/mission/landing_state_machine.h"
#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/own_state/own_state_options.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/estimation/pad/pad_predictor.h"
#include "touchdown/planning/look/scout.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/map/persistent_map.h"
#include "touchdown/planning/replan/planner.h"
#include "touchdown/planning/spline/limits.h"

namespace touchdown::control {

/// Of plans: the tracking law may use more.
struct Envelope {
  double speed = 3.0;         ///< in (0, 100] [m/s]
  double acceleration = 6.0;  ///< in (0, 100] [m/s^2]
  double tilt_deg = 35.0;     ///< in (0, 60] [deg]
  double ceiling = 10.0;      ///< the body's origin stays below this, in (0, 1000] [m]

  /// Speed, and acceleration as the tilt allows it.
  planning::Limits limits() const;
  /// Of stops: beyond that of plans, so that gusts and steady wind do not lengthen the way to rest
  /// [rad].
  double StopTilt() const;
  /// 1 sigma of the pad's velocity before it is measured [m/s]. A pad may be nearly as fast as the
  /// vehicle, and with a narrow prior the gate would reject its fixes for ever.
  double PadSpeedPrior() const;
  /// Of the tracking law [rad].
  double TrackingTilt() const;
};

/// From the time of a question to the time at which its answer is flown.
struct PlanLatency {
  double time = 0.0;  ///< that is waited for every answer, >= 0 [s]
  bool measured =
      false;  ///< instead: as long as the last answer took by the wall clock, and a fifth more.
              ///< Then flights do not repeat bit by bit
  double longest = 0.1;  ///< ... but no longer than this, >= 1 ms [s]
};

/// Numbers and switches. The defaults land the default vehicle.
struct OnboardOptions {
  estimation::VehicleModel model;
  Envelope envelope;

  DescentStyle descent = DescentStyle::kPlanned;  ///< kNone: it stays above the pad
  bool to_goal =
      false;  ///< the predictor's target is known from the beginning, and is no pad: with kNone
  bool end_at_rest = false;       ///< plans end at rest over the pad, not with its velocity
  double deck_size = 1.5;         ///< side of the pad's square deck [m]
  double corridor_radius = 0.12;  ///< of the descent's narrow end, > 0 [m]

  double mission_rate = 100.0;  ///< state machine and heading, in (0, 1000] [Hz]
  double replan_rate = 10.0;    ///< in (0, 1000] [Hz]
  double close_rate = 20.0;     ///< ... shortly before contact [Hz]
  PlanLatency latency;
  /// The shortest plan that ends in contact, as the planner has it (ReplannerOptions) [s].
  double shortest_contact_plan = 0.3;
  bool estimate_disturbance = true;  ///< and compensate it, where the law does so

  /// None: the own state is given, as by motion capture. Else it is estimated.
  std::optional<estimation::OwnStateOptions> own_state;
  /// The own sensors' time stamps are ahead of all others by this [s].
  double own_clock_ahead = 0.0;
  double history = 1.0;  ///< given states are kept so long, for what comes late [s], in (0, 100]
  estimation::PadFilterOptions pad;
  planning::OccupancyMapOptions map;
  double start_free =
      0.8;  ///< radius around the start that counts as free, at least 0.45 m from the hull [m]
};

/// What an Onboard is made of, besides.
struct OnboardParts {
  std::unique_ptr<planning::Planner> planner;
  bool planner_lands = true;  ///< its plans may end in contact
  std::unique_ptr<planning::Scout> scout;  ///< says where to look from; nullptr: nowhere
  std::unique_ptr<Controller> controller;
  bool law_compensates =
      true;  ///< it is told of the disturbance, and its thrusts lead the rotors' lag
  std::unique_ptr<estimation::PadPredictor> predictor;
  std::optional<planning::PersistentMap> memory;  ///< what is known of the world before
};

/// Throw std::invalid_argument naming the first option out of its range.
void Validate(const Envelope& envelope);
void Validate(const OnboardOptions& options);

}  // namespace touchdown::control
