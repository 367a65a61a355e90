// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/planning/spline/flatness.h"

namespace touchdown::planning {

/// Control points of a spline, one per column.
using ControlPoints = Eigen::Matrix3Xd;

/// Position, velocity and acceleration at one instant, all in W.
struct SplineState {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// Uniform cubic B-spline in R^3 (eq. 12-15 of the paper). N control points Q_0..Q_{N-1} and a knot
/// interval h span M = N - 3 segments, T = M h. Time runs from t0 to t0 + T.
class UniformBspline {
 public:
  /// A spline that stands at the origin for one second from t = 0.
  UniformBspline();

  /// Throws std::invalid_argument if there are fewer than 4 control points, if h is not positive
  /// and finite, or if a number is not finite. Allocates.
  UniformBspline(const Eigen::Ref<const ControlPoints>& control_points, double interval, double t0);

  /// Room for this many control points: up to it neither Assign nor an assignment allocates.
  void Reserve(int control_points) {
    numbers_.reserve(3 * static_cast<std::size_t>(control_points));
  }

  /// As the constructor. Does not allocate if it has had this many control points before.
  void Assign(const Eigen::Ref<const ControlPoints>& control_points, double interval, double t0);

  /// One per column. A view of the spline.
  Eigen::Map<const ControlPoints> control_points() const {
    return {numbers_.data(), 3, static_cast<Eigen::Index>(numbers_.size() / 3)};
  }
  double interval() const { return h_; }  ///< h [s]
  double t0() const { return t0_; }       ///< start [s]
  int segments() const { return static_cast<int>(numbers_.size() / 3) - 3; }
  double duration() const { return segments() * h_; }  ///< T [s]
  double t_end() const { return t0_ + duration(); }    ///< [s]

  /// Position and its first three derivatives at time t, which is clamped to [t0, t0 + T]; NaN at NaN. The yaw
  /// fields are left zero. Does not allocate.
  FlatState Evaluate(double t) const;

  /// The same, but past the end it goes on at the end's velocity.
  FlatState EvaluateOnward(double t) const;

  /// The position alone, in W [m], as Evaluate gives it. Does not allocate.
  Eigen::Vector3d Position(double t) const;

  /// Integral of the squared norm of the jerk [m^2/s^5], which is constant on every segment. Does not
  /// allocate.
  double SquaredJerk() const;

  /// State at knot k: p = (Q_k + 4 Q_{k+1} + Q_{k+2})/6 and its derivatives. Throws std::invalid_argument
  /// unless 0 <= k <= M.
  SplineState AtKnot(int k) const;

 private:
  struct Place {
    int segment;
    double u;  // in [0, 1], of the segment
  };
  Place PlaceOf(double t) const;
  Eigen::Vector3d PositionAt(const Place& place) const;

  std::vector<double> numbers_;  // of the control points; a vector keeps its memory
  double h_ = 1.0;
  double t0_ = 0.0;
};

/// Largest norms that velocity and acceleration can take anywhere on the curve. They come from the
/// convex hull of the Bezier points of its derivatives. Per segment these are the two knot values
/// and, for the velocity, the derivative control point between them.
struct DerivativeBounds {
  double speed = 0.0;         ///< [m/s]
  double acceleration = 0.0;  ///< [m/s^2]
  /// Of the thrust axis of a vehicle that flies it exactly, against the pull; where the thrust is less than the weight,
  /// as many times more: rotors that push less turn it less [rad/s].
  double body_rate = 0.0;
};
/// @param pull_W a steady force over the mass that acts beside gravity [m/s^2].
DerivativeBounds BoundDerivatives(const UniformBspline& curve,
                                  const Eigen::Vector3d& pull_W = Eigen::Vector3d::Zero());

}  // namespace touchdown::planning
