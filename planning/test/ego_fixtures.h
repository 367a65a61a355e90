// SPDX-License-Identifier: BSD-3-Clause
// Maps and plan calls shared by the tests of the EGO-Planner baseline.
#pragma once

#include "planning/baselines/ego/ego_grid.h"
#include "planning/baselines/ego/ego_plan.h"

namespace touchdown::planning {

inline CubeGrid EmptyGrid() { return CubeGrid({-10, -10, 0}, {20, 20, 3}, 0.1, 0.099); }

inline void AddBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, CubeGrid* grid) {
  for (double x = low.x() + 0.05; x < high.x(); x += 0.1) {
    for (double y = low.y() + 0.05; y < high.y(); y += 0.1) {
      for (double z = low.z() + 0.05; z < high.z(); z += 0.1) grid->SetOccupied({x, y, z});
    }
  }
}

/// A plan call from x = -4 m to `x` further, at a height of 1 m.
inline EgoRequest Ahead(double x = 7.5) {
  EgoRequest request;
  request.ends.start.p = {-4, 0, 1};
  request.ends.start.v = {1, 0, 0};
  request.ends.p_end = {-4 + x, 0, 1};
  request.ends.v_end = {x > 4 ? 1.5 : 0.0, 0, 0};
  request.t0 = 3.0;
  return request;
}

}  // namespace touchdown::planning
