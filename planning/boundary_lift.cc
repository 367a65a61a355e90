// SPDX-License-Identifier: BSD-3-Clause
// Both ends of a uniform cubic B-spline eliminated exactly. At a knot
//   p = (Q_i + 4 Q_{i+1} + Q_{i+2})/6, v = (Q_{i+2} - Q_i)/(2h), a = (Q_i - 2 Q_{i+1} +
//   Q_{i+2})/h^2,
// which is inverted at the first and the last knot. Between them the control points follow
//   c - (h^2/6) c'',  c the quintic Hermite polynomial between the ends:
// the quasi-interpolant that reproduces cubics. Its weights on (p0, T v0, T^2 a0, P, T V, T^2 A)
// are constants of the control point's index, so that derivatives with respect to T are plain.
// Without this lift the interior points stay put while free arrival moves the ends, which is stiff.

#include "touchdown/planning/boundary_lift.h"

#include <array>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

using Eigen::Vector3d;

/// A quantity with its first two derivatives with respect to T.
struct Moving {
  Vector3d value = Vector3d::Zero();
  Vector3d first = Vector3d::Zero();
  Vector3d second = Vector3d::Zero();
};

/// Weights of the six end values in control point i of M + 3.
std::array<double, 6> HermiteWeights(int i, int segments) {
  const double s = static_cast<double>(i - 1) / segments;
  const double s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
  const std::array<double, 6> value = {
      1.0 - 10.0 * s3 + 15.0 * s4 - 6.0 * s5,    s - 6.0 * s3 + 8.0 * s4 - 3.0 * s5,
      0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5, 10.0 * s3 - 15.0 * s4 + 6.0 * s5,
      -4.0 * s3 + 7.0 * s4 - 3.0 * s5,           0.5 * s3 - s4 + 0.5 * s5,
  };
  const std::array<double, 6> curvature = {
      -60.0 * s + 180.0 * s2 - 120.0 * s3,   -36.0 * s + 96.0 * s2 - 60.0 * s3,
      1.0 - 9.0 * s + 18.0 * s2 - 10.0 * s3, 60.0 * s - 180.0 * s2 + 120.0 * s3,
      -24.0 * s + 84.0 * s2 - 60.0 * s3,     3.0 * s - 12.0 * s2 + 10.0 * s3,
  };
  std::array<double, 6> weights;
  for (int j = 0; j < 6; ++j) {
    weights[j] = value[j] - curvature[j] / (6.0 * segments * segments);
  }
  return weights;
}

/// T^n x and its derivatives.
Moving Scaled(const Moving& x, double T, int n) {
  if (n == 0) return x;
  if (n == 1) return {T * x.value, x.value + T * x.first, 2.0 * x.first + T * x.second};
  return {T * T * x.value, 2.0 * T * x.value + T * T * x.first,
          2.0 * x.value + 4.0 * T * x.first + T * T * x.second};
}

struct Ends {
  Moving p0, v0, a0, p, v, a;
};

/// Every control point's offset as a function of T.
Moving ControlPoint(int i, int segments, double T, const Ends& e) {
  const int n = segments + 3;
  const double m = segments;
  const auto combine = [&](double cp, const Moving& p, double cv, const Moving& v, double ca,
                           const Moving& a) {
    const Moving tv = Scaled(v, T, 1);
    const Moving ta = Scaled(a, T, 2);
    // h v = T v / M, h^2 a = T^2 a / M^2.
    return Moving{cp * p.value + cv / m * tv.value + ca / (m * m) * ta.value,
                  cp * p.first + cv / m * tv.first + ca / (m * m) * ta.first,
                  cp * p.second + cv / m * tv.second + ca / (m * m) * ta.second};
  };
  if (i < 3) return combine(1.0, e.p0, i - 1.0, e.v0, i == 1 ? -1.0 / 6.0 : 1.0 / 3.0, e.a0);
  if (i >= n - 3) {
    const double j = i - (n - 2);  // -1, 0, 1; delta = -h^2 a / 6 enters with -2, 1, -2
    return combine(1.0, e.p, j, e.v, j == 0.0 ? -1.0 / 6.0 : 1.0 / 3.0, e.a);
  }
  const std::array<double, 6> w = HermiteWeights(i, segments);
  const std::array<Moving, 6> terms = {Scaled(e.p0, T, 0), Scaled(e.v0, T, 1), Scaled(e.a0, T, 2),
                                       Scaled(e.p, T, 0),  Scaled(e.v, T, 1),  Scaled(e.a, T, 2)};
  Moving out;
  for (int k = 0; k < 6; ++k) {
    out.value += w[k] * terms[k].value;
    out.first += w[k] * terms[k].first;
    out.second += w[k] * terms[k].second;
  }
  return out;
}

}  // namespace

ControlPoints HermiteControlPoints(const SplineState& start, const SplineState& end, int segments,
                                   double duration) {
  Ends ends;
  ends.p0.value = start.p;
  ends.v0.value = start.v;
  ends.a0.value = start.a;
  ends.p.value = end.p;
  ends.v.value = end.v;
  ends.a.value = end.a;
  ControlPoints points(3, segments + 3);
  for (int i = 0; i < segments + 3; ++i) {
    points.col(i) = ControlPoint(i, segments, duration, ends).value;
  }
  return points;
}

BoundaryLift::BoundaryLift(int segments, bool free_end_acceleration)
    : segments_(segments), free_end_acceleration_(free_end_acceleration) {
  if (segments < 4) {
    throw std::invalid_argument("BoundaryLift: " + std::to_string(segments) +
                                " segments, it needs at least 4");
  }
}

void BoundaryLift::Set(const SplineState& start, double t0, const estimation::PadPrediction& pad,
                       const EndpointTarget& target) {
  start_ = start;
  t0_ = t0;
  pad_ = &pad;
  target_ = target;
}

solvers::AffineLift BoundaryLift::Structure() const {
  const int n = segments_ + 3;
  solvers::AffineLift lift;
  lift.block.assign(static_cast<std::size_t>(n), -1);
  lift.coefficient.assign(static_cast<std::size_t>(n), 0.0);
  int reduced = 0;
  for (int i = 3; i < n - 3; ++i) {
    lift.block[i] = reduced++;
    lift.coefficient[i] = 1.0;
  }
  if (free_end_acceleration_) {
    const double delta[3] = {-2.0, 1.0, -2.0};
    for (int j = 0; j < 3; ++j) {
      lift.block[n - 3 + j] = reduced;
      lift.coefficient[n - 3 + j] = delta[j];
    }
    ++reduced;
  }
  lift.reduced_blocks = reduced;
  return lift;
}

void BoundaryLift::At(double h, double* l, double* dl, double* d2l) const noexcept {
  const double T = segments_ * h;
  const EndState end = EndStateAt(*pad_, target_, t0_ + T);
  Ends ends;
  ends.p0.value = start_.p;
  ends.v0.value = start_.v;
  ends.a0.value = start_.a;
  ends.p = {end.state.p, end.derivative.p, end.second_derivative.p};
  ends.v = {end.state.v, end.derivative.v, end.second_derivative.v};
  // A free end acceleration is measured from zero: its reduced block holds delta itself.
  if (!free_end_acceleration_) {
    ends.a = {end.state.a, end.derivative.a, end.second_derivative.a};
  }
  const double m = segments_;
  for (int i = 0; i < segments_ + 3; ++i) {
    const Moving q = ControlPoint(i, segments_, T, ends);
    for (int c = 0; c < 3; ++c) {
      l[3 * i + c] = q.value[c];
      if (dl) dl[3 * i + c] = m * q.first[c];  // dT/dh = M
      if (d2l) d2l[3 * i + c] = m * m * q.second[c];
    }
  }
}

}  // namespace touchdown::planning
