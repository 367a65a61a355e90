// SPDX-License-Identifier: BSD-3-Clause
// Quasi-interpolation by values and second derivatives. At a knot of a uniform cubic B-spline p -
// h^2/6 p'' is the control point above it (p = (Q_- + 4 Q + Q_+)/6, h^2 p'' = Q_- - 2 Q + Q_+). It
// reproduces a spline on the same knots exactly and is of fourth order elsewhere. The two outermost
// control points follow from the end velocities.

#include "planning/problem/warm_start.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "touchdown/planning/spline/boundary_lift.h"

namespace touchdown::planning {

void ShiftedControlPoints(const UniformBspline& previous, double t0, double duration,
                          Eigen::Ref<ControlPoints> q) {
  const int segments = static_cast<int>(q.cols()) - 3;
  if (segments < 1 || !(duration > 0.0) || !std::isfinite(duration)) {
    throw std::invalid_argument("ShiftedSpline: " + std::to_string(segments) + " segments in " +
                                std::to_string(duration) +
                                " s; at least 1 and a positive finite duration are needed");
  }
  const double from = std::clamp(t0, previous.t0(), previous.t_end());
  const double rate = (previous.t_end() - from) / duration;  // previous seconds per new second
  const double h = duration / segments;
  for (int k = 0; k <= segments; ++k) {
    const FlatState at = previous.Evaluate(from + rate * (k * h));
    q.col(k + 1) = at.p_WB - h * h / 6.0 * rate * rate * at.a_WB;
  }
  const Eigen::Vector3d v_start = rate * previous.Evaluate(from).v_WB;
  const Eigen::Vector3d v_end = rate * previous.Evaluate(previous.t_end()).v_WB;
  q.col(0) = q.col(2) - 2.0 * h * v_start;
  q.col(segments + 2) = q.col(segments) + 2.0 * h * v_end;
}

UniformBspline ShiftedSpline(const UniformBspline& previous, double t0, double duration,
                             int segments) {
  ControlPoints q(3, std::max(0, segments) + 3);
  ShiftedControlPoints(previous, t0, duration, q);
  return UniformBspline(q, duration / segments, t0);
}

namespace {

SplineState Difference(const SplineState& a, const SplineState& b) {
  return {a.p - b.p, a.v - b.v, a.a - b.a};
}

}  // namespace

UniformBspline WithEnds(const UniformBspline& curve, const SplineState& start,
                        const SplineState& end) {
  const int segments = curve.segments();
  const ControlPoints missing =
      HermiteControlPoints(Difference(start, curve.AtKnot(0)),
                           Difference(end, curve.AtKnot(segments)), segments, curve.duration());
  return UniformBspline(curve.control_points() + missing, curve.interval(), curve.t0());
}

}  // namespace touchdown::planning
