// SPDX-License-Identifier: BSD-3-Clause
// Costs and gradients of Zhou et al. 2021, with the scalings of the published system.

#include "planning/baselines/ego/ego_cost.h"

#include <cmath>

namespace touchdown::planning {

namespace {

constexpr double kAxial2 = 25.0;  // a^2 of eq. 14; b^2 is 1

}  // namespace

double EgoSmoothness(const ControlPoints& q, double weight, ControlPoints* gradient) {
  double cost = 0.0;
  for (int i = 0; i + 3 < q.cols(); ++i) {
    const Eigen::Vector3d d = q.col(i + 3) - 3.0 * q.col(i + 2) + 3.0 * q.col(i + 1) - q.col(i);
    cost += d.squaredNorm();
    const Eigen::Vector3d g = 2.0 * weight * d;
    gradient->col(i) -= g;
    gradient->col(i + 1) += 3.0 * g;
    gradient->col(i + 2) -= 3.0 * g;
    gradient->col(i + 3) += g;
  }
  return cost;
}

double EgoCollision(const ControlPoints& q, const SurfacePairs& pairs, double clearance,
                    double weight, ControlPoints* gradient) {
  const double s = clearance;
  double cost = 0.0;
  for (int i = kEgoDegree; i < q.cols() - kEgoDegree; ++i) {
    for (const SurfacePair& pair : pairs[i]) {
      const double e = s - (q.col(i) - pair.p).dot(pair.v);
      if (e <= 0.0) continue;
      double slope;
      if (e < s) {
        cost += e * e * e;
        slope = 3.0 * e * e;
      } else {
        cost += 3.0 * s * e * e - 3.0 * s * s * e + s * s * s;
        slope = 6.0 * s * e - 3.0 * s * s;
      }
      gradient->col(i) -= weight * slope * pair.v;
    }
  }
  return cost;
}

double EgoFeasibility(const ControlPoints& q, double interval, double max_speed,
                      double max_acceleration, double weight, ControlPoints* gradient) {
  const double h = interval;
  const int N = static_cast<int>(q.cols());
  const auto excess = [](double value, double limit) {
    return value > limit ? value - limit : (value < -limit ? value + limit : 0.0);
  };
  double cost = 0.0;
  for (int i = 0; i + 1 < N; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double over = excess((q(c, i + 1) - q(c, i)) / h, max_speed);
      if (over == 0.0) continue;
      cost += over * over / (h * h);
      const double g = weight * 2.0 * over / (h * h * h);
      (*gradient)(c, i) -= g;
      (*gradient)(c, i + 1) += g;
    }
  }
  for (int i = 0; i + 2 < N; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double a = (q(c, i + 2) - 2.0 * q(c, i + 1) + q(c, i)) / (h * h);
      const double over = excess(a, max_acceleration);
      if (over == 0.0) continue;
      cost += over * over;
      const double g = weight * 2.0 * over / (h * h);
      (*gradient)(c, i) += g;
      (*gradient)(c, i + 1) -= 2.0 * g;
      (*gradient)(c, i + 2) += g;
    }
  }
  return cost;
}

double EgoFitness(const ControlPoints& q, const std::vector<Eigen::Vector3d>& reference,
                  double weight, ControlPoints* gradient) {
  const int N = static_cast<int>(q.cols());
  double cost = 0.0;
  for (int i = kEgoDegree - 1; i <= N - kEgoDegree; ++i) {
    const Eigen::Vector3d x =
        (q.col(i - 1) + 4.0 * q.col(i) + q.col(i + 1)) / 6.0 - reference[i - 1];
    const Eigen::Vector3d w = (reference[i] - reference[i - 2]).normalized();
    const double axial = x.dot(w);
    // |x cross w|^2 = |x|^2 - (x w)^2 for a unit vector w.
    cost += axial * axial / kAxial2 + x.cross(w).squaredNorm();
    const Eigen::Vector3d g = weight * (2.0 * axial / kAxial2 * w + 2.0 * (x - axial * w));
    gradient->col(i - 1) += g / 6.0;
    gradient->col(i) += 4.0 / 6.0 * g;
    gradient->col(i + 1) += g / 6.0;
  }
  return cost;
}

}  // namespace touchdown::planning
