// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// Positions at equal times, and the derivatives wanted at both ends.
struct SampledPath {
  std::vector<Eigen::Vector3d> points;  ///< in W [m]
  double interval = 0.0;                ///< between two points [s]
  Eigen::Vector3d v_start = Eigen::Vector3d::Zero(), v_end = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d a_start = Eigen::Vector3d::Zero(), a_end = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// The N = K + 2 control points of the uniform cubic B-spline that best fits K points and the
/// derivatives at both ends. It is a least-squares fit over K + 4 equations, unweighted as
/// published. Allocates. Throws std::invalid_argument unless there are at least two points and
/// interval > 0.
ControlPoints FitBspline(const SampledPath& path);

}  // namespace touchdown::planning
