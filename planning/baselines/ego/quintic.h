// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// A polynomial of degree five over [0, T] in R^3.
struct Quintic {
  Eigen::Matrix<double, 3, 6> coefficients =
      Eigen::Matrix<double, 3, 6>::Zero();  ///< of t^0 .. t^5
  double duration = 0.0;                    ///< T [s]

  /// The one with the given states at both ends: the trajectory of least integrated squared jerk
  /// between them. @pre T > 0.
  static Quintic Between(const SplineState& start, const SplineState& end, double T);

  /// At t [s], not clamped.
  SplineState At(double t) const;
};

/// A chain of quintics.
struct QuinticChain {
  std::vector<Quintic> pieces;

  /// The chain of least integrated squared jerk through `points` (at least two), from start to end.
  /// Piece k lasts durations[k] seconds. Derivatives up to the fourth are continuous.
  static QuinticChain Through(const std::vector<Eigen::Vector3d>& points,
                              const std::vector<double>& durations, const SplineState& start,
                              const SplineState& end);

  double duration() const;         ///< [s]
  SplineState At(double t) const;  ///< at t [s], clamped to [0, duration()]
};

}  // namespace touchdown::planning
