// SPDX-License-Identifier: BSD-3-Clause
// Building blocks of inner maps: states at a knot from a window of three control points, and
// quantities that move with time. The latter have a form that automatic differentiation follows.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

#include "touchdown/planning/problem/landing_term.h"
#include "touchdown/solvers/problem/dual.h"

namespace touchdown::planning {

using solvers::ValueOf;

/// Three numbers of any scalar type.
template <class T>
using Triple = std::array<T, 3>;

/// p = (Q_k + 4 Q_{k+1} + Q_{k+2}) / 6 [m].
template <class T>
Triple<T> KnotPosition(const T* q) {
  Triple<T> p;
  for (int c = 0; c < 3; ++c) p[c] = (q[c] + 4.0 * q[3 + c] + q[6 + c]) * (1.0 / 6.0);
  return p;
}

/// v = (Q_{k+2} - Q_k) / (2 h) [m/s].
template <class T>
Triple<T> KnotVelocity(const T* q, const T& h) {
  const T scale = 0.5 / h;
  Triple<T> v;
  for (int c = 0; c < 3; ++c) v[c] = (q[6 + c] - q[c]) * scale;
  return v;
}

/// a = A_k = (Q_k - 2 Q_{k+1} + Q_{k+2}) / h^2 [m/s^2].
template <class T>
Triple<T> KnotAcceleration(const T* q, const T& h) {
  const T scale = 1.0 / (h * h);
  Triple<T> a;
  for (int c = 0; c < 3; ++c) a[c] = (q[c] - 2.0 * q[3 + c] + q[6 + c]) * scale;
  return a;
}

template <class T>
T Dot(const Triple<T>& a, const Triple<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// x(t) whose value and first two derivatives at ValueOf(t) are given. Exact to second order, which
/// is enough for derivatives.
template <class T>
Triple<T> AtTime(const T& t, const Eigen::Vector3d& x, const Eigen::Vector3d& dx,
                 const Eigen::Vector3d& d2x) {
  const T dt = t - ValueOf(t);
  Triple<T> out;
  for (int c = 0; c < 3; ++c) out[c] = x[c] + dx[c] * dt + (0.5 * d2x[c]) * (dt * dt);
  return out;
}

/// The pad's position at time t.
template <class T>
Triple<T> PadPosition(const estimation::PadPrediction& pad, const T& t) {
  const estimation::PadState at = pad.MeanAt(ValueOf(t));
  return AtTime(t, at.p_WP, at.v_WP, at.a_WP);
}

/// The inner knots k = 1..M-1 in the last `span` seconds before arrival, by the interval of the
/// guess; none where there is no deck. They do not change during a solve. Windows of three blocks.
struct LastKnots {
  int first = 1;
  int count = 0;

  void Update(const LandingContext& context, double span) {
    const double from = std::ceil(context.segments - span / context.interval);
    first = static_cast<int>(std::clamp(from, 1.0, static_cast<double>(context.segments)));
    count = context.pad->has_deck() ? context.segments - first : 0;
  }
};

}  // namespace touchdown::planning
