// SPDX-License-Identifier: BSD-3-Clause
// Braking, climbing and escaping. The stopping point is the end of a cubic velocity profile from
// (v0, a0) to rest, p0 + T v0/2 + T^2 a0/12. Between the ends the spline follows the quintic
// Hermite polynomial.

#include "touchdown/planning/spline/rest_trajectory.h"

#include <algorithm>
#include <limits>

#include "touchdown/planning/spline/boundary_lift.h"

namespace touchdown::planning {

namespace {
constexpr int kSegments = 12;
constexpr double kShortest = 0.4;  // [s]
constexpr double kGrowth = 1.15;
constexpr int kMaxTries = 24;  // up to 0.4 s * 1.15^24 = 11 s
}  // namespace

void MakeRestTrajectory(const SplineState& start, double t0, const Eigen::Vector3d& shift,
                        const Limits& limits, UniformBspline* trajectory) {
  const double speed = std::max(limits.speed, start.v.norm());
  const double acceleration = std::max(limits.acceleration, start.a.norm());
  Eigen::Matrix<double, 3, kSegments + 3> points;
  const auto make = [&](double T) {
    SplineState end;
    end.p = start.p + 0.5 * T * start.v + T * T / 12.0 * start.a + shift;
    HermiteControlPoints(start, end, T, points);
    trajectory->Assign(points, T / kSegments, t0);
  };
  double best_T = kShortest;
  double least_excess = std::numeric_limits<double>::infinity();
  double T = kShortest;
  for (int i = 0; i <= kMaxTries; ++i, T *= kGrowth) {
    make(T);
    const DerivativeBounds bounds = BoundDerivatives(*trajectory, limits.pull_W);
    const double excess = std::max({bounds.speed / speed, bounds.acceleration / acceleration,
                                    bounds.body_rate / limits.body_rate});
    if (excess <= 1.0 + 1e-9) return;
    if (excess < least_excess) {
      least_excess = excess;
      best_T = T;
    }
  }
  // A start that still speeds up at its limit cannot keep it. The least excess is used then.
  make(best_T);
}

UniformBspline MakeRestTrajectory(const SplineState& start, double t0, const Eigen::Vector3d& shift,
                                  const Limits& limits) {
  UniformBspline trajectory;
  MakeRestTrajectory(start, t0, shift, limits, &trajectory);
  return trajectory;
}

}  // namespace touchdown::planning
