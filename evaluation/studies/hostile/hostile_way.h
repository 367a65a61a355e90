// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Whether a hostile world can be flown at all; decided before anything is flown. A* on the true obstacles searches
/// from the start to above the pad's lane, at a place that the pad still reaches. Clearance, speed and acceleration are
/// figures of the study alone: none comes from what the planner assumes.
struct HostileWay {
  bool exists = false;
  double clearance = 0.0;  ///< around the body's centre, with which it was looked for [m]
  double length = 0.0;     ///< of the way, if there is one [m]
};

/// 0.55 m in calm air with a true own state. 0.70 m with an estimated one or a wind that exceeds 5 m/s. 0.85 m with
/// both.
double WayClearance(const Scenario& scenario);

/// The pad must be caught within `horizon` [s].
HostileWay FindWay(const Scenario& scenario, const Registries& registries, double horizon);

}  // namespace touchdown::evaluation
