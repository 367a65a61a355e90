// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// Where a plan ends, relative to the moving pad (eq. 17-18). It has a height of the body's origin
/// above the deck, which may sink with time, and the approach velocity w at arrival.
struct EndpointTarget {
  double t_reference = 0.0;   ///< when `height` holds [s]
  double height = 1.5;        ///< body origin above the deck at t_reference [m]
  double sink_rate = 0.0;     ///< rate at which the height shrinks, >= 0 [m/s]
  double height_floor = 0.0;  ///< the height never goes below this [m]
  /// A plan that ends in contact sinks at arrival, whatever the height does until then: >= 0 [m/s].
  double arrival_sink = 0.0;
  /// The end stands still, whatever velocity the pad has: w alone is its velocity. To show the
  /// benefit of the moving end.
  bool at_rest = false;
  /// Velocity relative to the pad's at the end, in W [m/s], for an end that is only passed. No
  /// record holds it: no mission asks for it.
  Eigen::Vector3d passing_W = Eigen::Vector3d::Zero();

  /// Whether the plan is to end in contact.
  bool touches() const { return arrival_sink > 0.0; }
  /// Whether what follows it is contact: by this plan, or by the ones that sink with the height.
  bool leads_to_contact() const { return touches() || sink_rate > 0.0; }
  /// Whether it may end in contact: a level stretch at the end of a landing, or a vertical descent, goes below the
  /// height of contact [m].
  bool may_touch(double contact_height) const { return touches() || height_floor < contact_height; }
};

/// The end condition at an arrival time, with the derivatives with respect to it that free arrival
/// needs. dp/dT = pad velocity + rate of the height, dv/dT = pad acceleration, da/dT = pad jerk.
struct EndState {
  SplineState state;              ///< wanted p, v, a at arrival, in W
  SplineState derivative;         ///< d(state)/dT
  SplineState second_derivative;  ///< d2(state)/dT2, pad jerk held
};

/// The end condition for an arrival at the absolute time `t_arrival`. Does not allocate.
EndState EndStateAt(const estimation::PadPrediction& pad, const EndpointTarget& target,
                    double t_arrival) noexcept;

}  // namespace touchdown::planning
