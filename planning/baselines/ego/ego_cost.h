// SPDX-License-Identifier: BSD-3-Clause
// The costs of the EGO-Planner baseline. Each returns its value and adds `weight` times its gradient
// with respect to all control points to `gradient` (3 x N). None allocates.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "planning/baselines/ego/collision_segments.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// Sum of the squared third differences of the control points (Zhou et al., eq. 4, its jerk part),
/// not scaled by time.
double EgoSmoothness(const ControlPoints& q, double weight, ControlPoints* gradient);

/// Sum over control points p .. N-p-1 and their pairs of j(clearance - d), d = (q - p) v: zero, cubic,
/// and from `clearance` on quadratic (eq. 5-7).
double EgoCollision(const ControlPoints& q, const SurfacePairs& pairs, double clearance,
                    double weight, ControlPoints* gradient);

/// Squared excess of each axis of the velocity's and acceleration's control points over its limit;
/// the velocity's divided by the squared interval.
double EgoFeasibility(const ControlPoints& q, double interval, double max_speed,
                      double max_acceleration, double weight, ControlPoints* gradient);

/// Anisotropic distance of the curve's knots to `reference`, N - 2 points at the same times: axial
/// parts count 1/25 of radial ones (eq. 14-16).
double EgoFitness(const ControlPoints& q, const std::vector<Eigen::Vector3d>& reference,
                  double weight, ControlPoints* gradient);

}  // namespace touchdown::planning
