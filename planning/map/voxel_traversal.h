// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace touchdown::planning {

/// Visits every lattice cell that the segment from `a` to `b` passes, in order, the cells of both
/// ends included. `visit(cell)` returns false to end early; the result tells whether all were
/// visited. Source: J. Amanatides and A. Woo, "A fast voxel traversal algorithm for ray tracing",
/// Eurographics 1987. Does not allocate.
template <class Visit>
bool TraverseCells(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double resolution,
                   Visit&& visit) {
  const Eigen::Vector3d from = a / resolution;
  const Eigen::Vector3d along = (b - a) / resolution;
  Eigen::Vector3i cell = from.array().floor().matrix().cast<int>();
  const Eigen::Vector3i last = (b / resolution).array().floor().matrix().cast<int>();
  // The number of faces between the two end cells bounds the walk, whatever rounding does.
  const int faces = (last - cell).cwiseAbs().sum();
  if (faces == 0) return visit(cell);
  Eigen::Vector3i step = Eigen::Vector3i::Zero();
  Eigen::Vector3d next, delta;  // ray parameter of the next face on each axis, and between faces
  for (int c = 0; c < 3; ++c) {
    if (along[c] == 0.0) {
      next[c] = delta[c] = std::numeric_limits<double>::infinity();
      continue;
    }
    step[c] = along[c] > 0.0 ? 1 : -1;
    delta[c] = std::abs(1.0 / along[c]);
    const double face = along[c] > 0.0 ? cell[c] + 1.0 : cell[c];
    next[c] = (face - from[c]) / along[c];
  }
  for (int remaining = faces; remaining >= 0; --remaining) {
    if (!visit(cell)) return false;
    int axis;
    next.minCoeff(&axis);
    if (cell[axis] == last[axis] && remaining > 0) {
      // Rounding at an edge: go on along an axis that is not there yet.
      for (int c = 0; c < 3; ++c) {
        if (cell[c] != last[c]) axis = c;
      }
    }
    cell[axis] += step[axis];
    next[axis] += delta[axis];
  }
  return true;
}

}  // namespace touchdown::planning
