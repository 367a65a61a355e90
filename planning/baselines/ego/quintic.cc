// SPDX-License-Identifier: BSD-3-Clause
// Quintic Hermite polynomials, and chains of them. A chain of least jerk leaves velocity and
// acceleration at each inner point free. Its third and fourth derivative are continuous there (the
// natural conditions of the variation), which gives two linear equations per point.

#include "planning/baselines/ego/quintic.h"

#include <Eigen/LU>
#include <algorithm>

namespace touchdown::planning {

namespace {

/// Derivatives of the coefficients of t^3, t^4, t^5 with respect to (p0, v0, a0, p1, v1, a1).
Eigen::Matrix<double, 3, 6> HermiteRows(double T) {
  Eigen::Matrix<double, 3, 6> rows;
  rows << -20.0, -12.0 * T, -3.0 * T * T, 20.0, -8.0 * T, T * T,   //
      30.0, 16.0 * T, 3.0 * T * T, -30.0, 14.0 * T, -2.0 * T * T,  //
      -12.0, -6.0 * T, -T * T, 12.0, -6.0 * T, T * T;
  const double T3 = T * T * T;
  rows.row(0) /= 2.0 * T3;
  rows.row(1) /= 2.0 * T3 * T;
  rows.row(2) /= 2.0 * T3 * T * T;
  return rows;
}

}  // namespace

Quintic Quintic::Between(const SplineState& start, const SplineState& end, double T) {
  Eigen::Matrix<double, 6, 3> ends;
  ends << start.p.transpose(), start.v.transpose(), start.a.transpose(), end.p.transpose(),
      end.v.transpose(), end.a.transpose();
  Quintic quintic;
  quintic.duration = T;
  quintic.coefficients.col(0) = start.p;
  quintic.coefficients.col(1) = start.v;
  quintic.coefficients.col(2) = 0.5 * start.a;
  quintic.coefficients.rightCols<3>() = (HermiteRows(T) * ends).transpose();
  return quintic;
}

SplineState Quintic::At(double t) const {
  SplineState state;
  for (int k = 5; k >= 0; --k) {
    state.a = t * state.a + 2.0 * state.v;
    state.v = t * state.v + state.p;
    state.p = t * state.p + coefficients.col(k);
  }
  return state;
}

QuinticChain QuinticChain::Through(const std::vector<Eigen::Vector3d>& points,
                                   const std::vector<double>& durations, const SplineState& start,
                                   const SplineState& end) {
  const int pieces = static_cast<int>(durations.size());
  const int inner = pieces - 1;
  std::vector<SplineState> states(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) states[i].p = points[i];
  states.front() = start;
  states.back() = end;
  if (inner > 0) {
    // Unknown (v, a) of inner point i stand at 2 (i - 1). Jerk and snap before it equal those after.
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * inner, 2 * inner);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(2 * inner, 3);
    for (int i = 1; i <= inner; ++i) {
      for (const int side : {-1, 1}) {
        const int piece = side < 0 ? i - 1 : i;
        const double T = side < 0 ? durations[piece] : 0.0;  // of the piece's own time at the point
        const Eigen::Matrix<double, 3, 6> rows = HermiteRows(durations[piece]);
        Eigen::Matrix<double, 2, 6> jump;
        jump.row(0) = 6.0 * rows.row(0) + 24.0 * T * rows.row(1) + 60.0 * T * T * rows.row(2);
        jump.row(1) = 24.0 * rows.row(1) + 120.0 * T * rows.row(2);
        jump *= side;
        for (int e = 0; e < 2; ++e) {
          const int point = piece + e;
          const SplineState& known = states[point];
          b.middleRows<2>(2 * (i - 1)) -= jump.col(3 * e) * known.p.transpose();
          if (point >= 1 && point <= inner) {
            A.block<2, 2>(2 * (i - 1), 2 * (point - 1)) += jump.middleCols<2>(3 * e + 1);
          } else {
            b.middleRows<2>(2 * (i - 1)) -= jump.col(3 * e + 1) * known.v.transpose() +
                                            jump.col(3 * e + 2) * known.a.transpose();
          }
        }
      }
    }
    const Eigen::MatrixXd solution = A.partialPivLu().solve(b);
    for (int i = 1; i <= inner; ++i) {
      states[i].v = solution.row(2 * (i - 1)).transpose();
      states[i].a = solution.row(2 * (i - 1) + 1).transpose();
    }
  }
  QuinticChain chain;
  for (int k = 0; k < pieces; ++k) {
    chain.pieces.push_back(Quintic::Between(states[k], states[k + 1], durations[k]));
  }
  return chain;
}

double QuinticChain::duration() const {
  double sum = 0.0;
  for (const Quintic& piece : pieces) sum += piece.duration;
  return sum;
}

SplineState QuinticChain::At(double t) const {
  t = std::clamp(t, 0.0, duration());
  std::size_t k = 0;
  while (k + 1 < pieces.size() && t > pieces[k].duration) t -= pieces[k++].duration;
  return pieces[k].At(std::min(t, pieces[k].duration));
}

}  // namespace touchdown::planning
