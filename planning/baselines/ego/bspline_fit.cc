// SPDX-License-Identifier: BSD-3-Clause
// At a knot p = (1, 4, 1)/6, v = (-1, 0, 1)/(2h), a = (1, -2, 1)/h^2 of three control points. One QR
// factorisation serves all three axes.

#include "planning/baselines/ego/bspline_fit.h"

#include <Eigen/QR>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

ControlPoints FitBspline(const SampledPath& path) {
  const int K = static_cast<int>(path.points.size());
  const double h = path.interval;
  if (K < 2 || !(h > 0.0)) {
    throw std::invalid_argument("FitBspline: " + std::to_string(K) + " points at an interval of " +
                                std::to_string(h) + " s, it needs at least 2 and > 0 s");
  }
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(K + 4, K + 2);
  Eigen::MatrixXd b(K + 4, 3);
  const Eigen::RowVector3d position(1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0);
  const Eigen::RowVector3d velocity(-0.5 / h, 0.0, 0.5 / h);
  const Eigen::RowVector3d acceleration = Eigen::RowVector3d(1.0, -2.0, 1.0) / (h * h);
  for (int k = 0; k < K; ++k) {
    A.block<1, 3>(k, k) = position;
    b.row(k) = path.points[k].transpose();
  }
  A.block<1, 3>(K, 0) = velocity;
  A.block<1, 3>(K + 1, K - 1) = velocity;
  A.block<1, 3>(K + 2, 0) = acceleration;
  A.block<1, 3>(K + 3, K - 1) = acceleration;
  b.row(K) = path.v_start.transpose();
  b.row(K + 1) = path.v_end.transpose();
  b.row(K + 2) = path.a_start.transpose();
  b.row(K + 3) = path.a_end.transpose();
  return A.colPivHouseholderQr().solve(b).transpose();
}

}  // namespace touchdown::planning
