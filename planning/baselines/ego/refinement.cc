// SPDX-License-Identifier: BSD-3-Clause
// Time re-allocation and refinement. The stretched curve is a spline with unequal knots; it is
// evaluated by de Boor's recursion (C. de Boor, "On calculating with B-splines", 1972). As
// published, the result is not checked against the limits again.

#include "planning/baselines/ego/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planning/baselines/ego/ego_cost.h"

namespace touchdown::planning {

namespace {

constexpr double kSlack = 1e-4;     // of the limits, absolute
constexpr int kFixedKnots = 5;      // at either end of the knot vector
constexpr double kRounding = 1e-9;  // [s]

/// Position of a cubic B-spline with any knots u (N + 4 of them) at u[3] <= t <= u[N].
Eigen::Vector3d DeBoor(const ControlPoints& q, const std::vector<double>& u, double t) {
  const int N = static_cast<int>(q.cols());
  int k = kEgoDegree;
  while (k + 1 < N && t > u[k + 1]) ++k;
  std::array<Eigen::Vector3d, kEgoDegree + 1> d;
  for (int i = 0; i <= kEgoDegree; ++i) d[i] = q.col(k - kEgoDegree + i);
  for (int r = 1; r <= kEgoDegree; ++r) {
    for (int i = kEgoDegree; i >= r; --i) {
      const double low = u[i + k - kEgoDegree], high = u[i + 1 + k - r];
      const double alpha = (t - low) / (high - low);
      d[i] = (1.0 - alpha) * d[i - 1] + alpha * d[i];
    }
  }
  return d[kEgoDegree];
}

}  // namespace

LimitExcess CheckLimits(const ControlPoints& q, double interval, const EgoOptions& options) {
  double speed = 0.0, acceleration = 0.0;
  for (int i = 0; i + 1 < q.cols(); ++i) {
    speed = std::max(speed, (q.col(i + 1) - q.col(i)).cwiseAbs().maxCoeff() / interval);
  }
  for (int i = 0; i + 2 < q.cols(); ++i) {
    const Eigen::Vector3d second = q.col(i + 2) - 2.0 * q.col(i + 1) + q.col(i);
    acceleration = std::max(acceleration, second.cwiseAbs().maxCoeff() / (interval * interval));
  }
  const double tolerance = 1.0 + options.limit_tolerance;
  LimitExcess excess;
  excess.feasible = speed <= options.max_speed * tolerance + kSlack &&
                    acceleration <= options.max_acceleration * tolerance + kSlack;
  excess.ratio =
      std::max(speed / options.max_speed, std::sqrt(acceleration / options.max_acceleration));
  return excess;
}

SampledPath StretchTime(const ControlPoints& q, double interval, double ratio,
                        const SampledPath& ends) {
  const int N = static_cast<int>(q.cols());
  const int knots = N + kEgoDegree + 1;
  std::vector<double> u(static_cast<std::size_t>(knots));
  for (int i = 0; i < knots; ++i) u[i] = (i - kEgoDegree) * interval;
  const int first = kFixedKnots, last = knots - 1 - kFixedKnots;
  if (last > first) {
    const double step = (ratio - 1.0) * interval;  // that each inner interval grows by
    for (int i = first + 1; i < knots; ++i) u[i] += step * (std::min(i, last) - first);
  }
  SampledPath path = ends;
  path.points.clear();
  path.interval = (u[N] - u[kEgoDegree]) / (N - kEgoDegree);
  for (int k = 0; k <= N - kEgoDegree; ++k) {
    const double t = u[kEgoDegree] + k * path.interval;
    path.points.push_back(DeBoor(q, u, std::min(t, u[N] - kRounding * interval)));
  }
  return path;
}

EgoStatus Refinement::Run(const EgoGrid& grid, double ratio, const SampledPath& ends,
                          double* interval, ControlPoints* q) {
  reference_ = StretchTime(*q, *interval, ratio, ends);
  *interval = reference_.interval;
  q_ = FitBspline(reference_);
  gradient_.setZero(3, q_.cols());
  const int free = static_cast<int>(q_.cols()) - 2 * kEgoDegree;
  lbfgs_.Prepare(3 * free, options_.memory);
  x_ = q_.middleCols(kEgoDegree, free).reshaped();
  solvers::LbfgsOptions lbfgs;
  lbfgs.gradient_tolerance = options_.refine_tolerance;
  lbfgs.max_iterations = options_.max_iterations;
  const solvers::LbfgsResult run = lbfgs_.Minimize(lbfgs, this, &x_);
  iterations_ = run.iterations;
  *q = q_;
  if (run.status == solvers::LbfgsStatus::kLineSearchFailed ||
      run.status == solvers::LbfgsStatus::kEvaluationFailed) {
    return EgoStatus::kSolverFailed;
  }
  double t = 0.0;
  return FirstTwoThirdsBlocked(UniformBspline(q_, *interval, 0.0), grid, &t)
             ? EgoStatus::kRefinementHit
             : EgoStatus::kPlanned;
}

double Refinement::Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  const int free = static_cast<int>(q_.cols()) - 2 * kEgoDegree;
  q_.middleCols(kEgoDegree, free).reshaped() = x;
  gradient_.setZero();
  double cost =
      options_.weight_smoothness * EgoSmoothness(q_, options_.weight_smoothness, &gradient_);
  cost += options_.weight_fitness *
          EgoFitness(q_, reference_.points, options_.weight_fitness, &gradient_);
  cost += options_.weight_feasibility * EgoFeasibility(q_, reference_.interval, options_.max_speed,
                                                       options_.max_acceleration,
                                                       options_.weight_feasibility, &gradient_);
  *gradient = gradient_.middleCols(kEgoDegree, free).reshaped();
  return cost;
}

}  // namespace touchdown::planning
