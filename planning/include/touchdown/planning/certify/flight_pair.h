// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// What is committed: a curve until the latest time at which a newer pair can take over, and from
/// then on a stop that was proven with it. It is flown without further questions (docs/safety.md).
struct FlightPair {
  UniformBspline curve;
  double t_stop = std::numeric_limits<double>::infinity();  ///< the stop begins [s]; infinite: the
                                                            ///< curve is a stop itself
  UniformBspline stop;
  bool proven = true;  ///< false: the least that could be done, and not a proven flight pair
  /// It begins among cells that no proven flight pair has led to; the first hover may.
  bool from_unknown = true;

  /// The reference at time t (yaw fields zero). Does not allocate.
  FlatState At(double t) const {
    return t < t_stop ? curve.EvaluateOnward(t) : stop.EvaluateOnward(t);
  }

  /// The one that ends it.
  const UniformBspline& Last() const { return std::isfinite(t_stop) ? stop : curve; }

  /// It ends in contact with the deck instead of at rest.
  bool Lands() const {
    constexpr double kRest = 1e-6;  // [m/s]
    return !std::isfinite(t_stop) && curve.AtKnot(curve.segments()).v.norm() > kRest;
  }
};

}  // namespace touchdown::planning
