// SPDX-License-Identifier: BSD-3-Clause
// Both ends of a uniform cubic B-spline eliminated exactly. At a knot
//   p = (Q_i + 4 Q_{i+1} + Q_{i+2})/6, v = (Q_{i+2} - Q_i)/(2h), a = (Q_i - 2 Q_{i+1} +
//   Q_{i+2})/h^2.
// This is inverted at the first and the last knot. Between them the control points follow
//   c - (h^2/6) c'',  c the quintic Hermite polynomial between the ends.
// This is the quasi-interpolant that reproduces cubics. Its weights on (p0, h v0, h^2 a0, P, h V,
// h^2 A) are constants of the control point's index. They are computed once, and derivatives with
// respect to h are simple. Without this lift the interior points do not move when free arrival
// moves the ends, which is stiff.

#include "touchdown/planning/spline/boundary_lift.h"

#include <array>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

using Eigen::Vector3d;

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
  // From (p0, T v0, T^2 a0, ...) to (p0, h v0, h^2 a0, ...).
  const double m = segments, power[6] = {1.0, m, m * m, 1.0, m, m * m};
  std::array<double, 6> weights;
  for (int j = 0; j < 6; ++j) weights[j] = power[j] * (value[j] - curvature[j] / (6.0 * m * m));
  return weights;
}

/// A column of end values (p0, h v0, h^2 a0, P, h V, h^2 A). Every control point's offset is a
/// fixed combination of it.
using EndColumn = BoundaryWeights::Column;

EndColumn Column(const SplineState& start, const SplineState& end, double h) {
  return {start.p, h * start.v, h * h * start.a, end.p, h * end.v, h * h * end.a};
}

/// sum_j w_j column_j.
void Combine(const BoundaryWeights& weights, const EndColumn& column, double* out) {
  for (int c = 0; c < 3; ++c) {
    double sum = weights.of[0] * column[0][c];
    for (int j = 1; j < 6; ++j) sum += weights.of[j] * column[j][c];
    out[c] = sum;
  }
}

/// The same for all control points, one after the other.
void Combine(const std::vector<BoundaryWeights>& weights, const EndColumn& column, double* out) {
  for (const BoundaryWeights& w : weights) {
    Combine(w, column, out);
    out += 3;
  }
}

/// Weights of the six end values in control point i of M + 3 with both ends eliminated.
BoundaryWeights WeightsAt(int i, int segments) {
  const int n = segments + 3;
  const double second = i == 1 || i == n - 2 ? -1.0 / 6.0 : 1.0 / 3.0;
  if (i < 3) return {{1.0, i - 1.0, second, 0.0, 0.0, 0.0}};
  if (i >= n - 3) return {{0.0, 0.0, 0.0, 1.0, i - (n - 2.0), second}};
  return {HermiteWeights(i, segments)};
}

}  // namespace

void HermiteControlPoints(const SplineState& start, const SplineState& end, double duration,
                          Eigen::Ref<ControlPoints> points) {
  const int segments = static_cast<int>(points.cols()) - 3;
  const EndColumn column = Column(start, end, duration / segments);
  for (int i = 0; i < points.cols(); ++i) {
    Combine(WeightsAt(i, segments), column, points.col(i).data());
  }
}

ControlPoints HermiteControlPoints(const SplineState& start, const SplineState& end, int segments,
                                   double duration) {
  ControlPoints points(3, segments + 3);
  HermiteControlPoints(start, end, duration, points);
  return points;
}

BoundaryLift::BoundaryLift(int segments, bool free_end_acceleration)
    : segments_(segments), free_end_acceleration_(free_end_acceleration) {
  if (segments < 4) {
    throw std::invalid_argument("BoundaryLift: " + std::to_string(segments) +
                                " segments, it needs at least 4");
  }
  for (int i = 0; i < segments + 3; ++i) weights_.push_back(WeightsAt(i, segments));
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
  const double m = segments_;  // dT/dh
  EndState end = EndStateAt(*pad_, target_, t0_ + m * h);
  // A free end acceleration is measured from zero: its reduced block holds delta itself.
  if (!free_end_acceleration_) {
    end.derivative.a *= m;
    end.second_derivative.a *= m * m;
  } else {
    end.state.a.setZero();
    end.derivative.a.setZero();
    end.second_derivative.a.setZero();
  }
  const SplineState& at = end.state;
  const Vector3d dP = m * end.derivative.p, dV = m * end.derivative.v, &dA = end.derivative.a;
  const Vector3d d2P = m * m * end.second_derivative.p, d2V = m * m * end.second_derivative.v;
  const Vector3d zero = Vector3d::Zero();
  Combine(weights_, Column(start_, at, h), l);
  if (dl) {
    Combine(weights_,
            {zero, start_.v, 2.0 * h * start_.a, dP, at.v + h * dV, 2.0 * h * at.a + h * h * dA},
            dl);
  }
  if (d2l) {
    Combine(weights_,
            {zero, zero, 2.0 * start_.a, d2P, 2.0 * dV + h * d2V,
             2.0 * at.a + 4.0 * h * dA + h * h * end.second_derivative.a},
            d2l);
  }
}

}  // namespace touchdown::planning
