// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// Largest speed that the curve may have anywhere, and past its end [m/s]. Does not allocate.
inline double FastestLeg(const UniformBspline& curve) {
  const Eigen::Map<const ControlPoints> q = curve.control_points();
  double longest2 = 0.0;
  for (int i = 0; i + 1 < q.cols(); ++i) {
    longest2 = std::max(longest2, (q.col(i + 1) - q.col(i)).squaredNorm());
  }
  return std::sqrt(longest2) / curve.interval();
}

}  // namespace touchdown::planning
