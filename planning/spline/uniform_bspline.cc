// SPDX-License-Identifier: BSD-3-Clause
// Evaluation of a uniform cubic B-spline by its basis matrix, and bounds of its derivatives by the
// convex hull of their Bezier points. Eq. 12-15 of the paper; C. de Boor, "A Practical Guide to
// Splines".

#include "touchdown/planning/spline/uniform_bspline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {

UniformBspline::UniformBspline() : numbers_(12, 0.0) {}

UniformBspline::UniformBspline(const Eigen::Ref<const ControlPoints>& control_points,
                               double interval, double t0) {
  Assign(control_points, interval, t0);
}

void UniformBspline::Assign(const Eigen::Ref<const ControlPoints>& control_points, double interval,
                            double t0) {
  if (control_points.cols() < 4) {
    throw std::invalid_argument("UniformBspline: " + std::to_string(control_points.cols()) +
                                " control points, it needs at least 4");
  }
  if (!(interval > 0.0) || !std::isfinite(interval)) {
    throw std::invalid_argument("UniformBspline: interval is " + std::to_string(interval) +
                                " s, it must be positive and finite");
  }
  if (!std::isfinite(t0) || !control_points.allFinite()) {
    throw std::invalid_argument("UniformBspline: start time or a control point is not finite");
  }
  numbers_.assign(control_points.data(), control_points.data() + control_points.size());
  h_ = interval;
  t0_ = t0;
}

FlatState UniformBspline::EvaluateOnward(double t) const {
  FlatState state = Evaluate(t);
  const double past = t - t_end();
  if (past > 0.0) {
    state.p_WB += past * state.v_WB;
    state.a_WB.setZero();
    state.j_WB.setZero();
  }
  return state;
}

double UniformBspline::SquaredJerk() const {
  const auto& q = control_points();
  double sum = 0.0;  // of |j|^2 h^6
  for (int i = 0; i + 3 < q.cols(); ++i) {
    sum += (q.col(i + 3) - 3.0 * q.col(i + 2) + 3.0 * q.col(i + 1) - q.col(i)).squaredNorm();
  }
  return sum / std::pow(h_, 5);
}

UniformBspline::Place UniformBspline::PlaceOf(double t) const {
  const double s = std::clamp((t - t0_) / h_, 0.0, static_cast<double>(segments()));
  const int i = s > 0.0 ? std::min(static_cast<int>(s), segments() - 1) : 0;  // NaN belongs nowhere
  return {i, s - i};
}

Eigen::Vector3d UniformBspline::PositionAt(const Place& place) const {
  const Eigen::Map<const ControlPoints> q = control_points();
  const double u = place.u, w = 1.0 - u;
  return (w * w * w * q.col(place.segment) +
          (4.0 - 6.0 * u * u + 3.0 * u * u * u) * q.col(place.segment + 1) +
          (1.0 + 3.0 * u + 3.0 * u * u - 3.0 * u * u * u) * q.col(place.segment + 2) +
          u * u * u * q.col(place.segment + 3)) /
         6.0;
}

Eigen::Vector3d UniformBspline::Position(double t) const { return PositionAt(PlaceOf(t)); }

FlatState UniformBspline::Evaluate(double t) const {
  const Place place = PlaceOf(t);
  const double u = place.u, w = 1.0 - u;
  const Eigen::Map<const ControlPoints> q = control_points();
  const auto q0 = q.col(place.segment);
  const auto q1 = q.col(place.segment + 1);
  const auto q2 = q.col(place.segment + 2);
  const auto q3 = q.col(place.segment + 3);

  FlatState out;
  out.p_WB = PositionAt(place);
  out.v_WB = (-w * w * q0 + (3.0 * u * u - 4.0 * u) * q1 + (1.0 + 2.0 * u - 3.0 * u * u) * q2 +
              u * u * q3) /
             (2.0 * h_);
  out.a_WB = (w * q0 + (3.0 * u - 2.0) * q1 + (1.0 - 3.0 * u) * q2 + u * q3) / (h_ * h_);
  out.j_WB = (-q0 + 3.0 * q1 - 3.0 * q2 + q3) / (h_ * h_ * h_);
  return out;
}

SplineState UniformBspline::AtKnot(int k) const {
  if (k < 0 || k > segments()) {
    throw std::invalid_argument("UniformBspline: knot " + std::to_string(k) +
                                ", it has knots 0 to " + std::to_string(segments()));
  }
  const Eigen::Map<const ControlPoints> q = control_points();
  const auto q0 = q.col(k);
  const auto q1 = q.col(k + 1);
  const auto q2 = q.col(k + 2);
  return {(q0 + 4.0 * q1 + q2) / 6.0, (q2 - q0) / (2.0 * h_), (q0 - 2.0 * q1 + q2) / (h_ * h_)};
}

DerivativeBounds BoundDerivatives(const UniformBspline& curve, const Eigen::Vector3d& pull_W) {
  const Eigen::Map<const ControlPoints> q = curve.control_points();
  const double h = curve.interval();
  DerivativeBounds bounds;
  // The specific thrust f = a + g e_z - pull is linear on a segment, so f x j is constant there.
  // The axis turns with |f x j| / |f|^2: fastest where f is shortest. Rotors at less than the weight have as much less
  // moment to turn it.
  const Eigen::Vector3d hover_W = estimation::kGravity * Eigen::Vector3d::UnitZ() - pull_W;
  SplineState from = curve.AtKnot(0);
  double speed2 = from.v.squaredNorm(), acceleration2 = from.a.squaredNorm();
  for (int i = 0; i < curve.segments(); ++i) {
    const SplineState to = curve.AtKnot(i + 1);
    speed2 = std::max(speed2, to.v.squaredNorm());
    acceleration2 = std::max(acceleration2, to.a.squaredNorm());
    // Bezier points of the velocity on segment i: v at knot i, V_{i+1}, v at knot i + 1. The first
    // and the last derivative control point, V_0 and V_{N-2}, are no Bezier points.
    bounds.speed = std::max(bounds.speed, (q.col(i + 2) - q.col(i + 1)).norm() / h);
    const Eigen::Vector3d thrust = from.a + hover_W;
    const Eigen::Vector3d change = to.a + hover_W - thrust;
    const double turn = thrust.cross(change).norm() / h;
    if (turn != 0.0) {
      const double nearest = std::clamp(-thrust.dot(change) / change.squaredNorm(), 0.0, 1.0);
      const double least2 = (thrust + nearest * change).squaredNorm();
      const double weaker = std::max(1.0, estimation::kGravity / std::sqrt(least2));
      bounds.body_rate = std::max(bounds.body_rate, turn / least2 * weaker);
    }
    from = to;
  }
  bounds.speed = std::max(bounds.speed, std::sqrt(speed2));
  bounds.acceleration = std::sqrt(acceleration2);
  return bounds;
}

}  // namespace touchdown::planning
