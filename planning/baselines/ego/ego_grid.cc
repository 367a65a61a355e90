// SPDX-License-Identifier: BSD-3-Clause
// The dense map of the published system: cubes instead of balls.

#include "planning/baselines/ego/ego_grid.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

CubeGrid::CubeGrid(const Eigen::Vector3d& corner, const Eigen::Vector3d& size, double resolution,
                   double inflation)
    : corner_(corner), resolution_(resolution) {
  constexpr double kMostCells = 1e8;
  if (!(resolution > 0.0)) {
    throw std::invalid_argument("CubeGrid: resolution is " + std::to_string(resolution) +
                                " m, it must be > 0 m");
  }
  if (!(inflation >= 0.0) || !std::isfinite(inflation)) {
    throw std::invalid_argument("CubeGrid: inflation is " + std::to_string(inflation) +
                                " m, it must be >= 0 m");
  }
  const Eigen::Array3d cells = (size / resolution).array().ceil();
  if (!(cells >= 1.0).all() || !(cells.prod() <= kMostCells)) {
    throw std::invalid_argument("CubeGrid: size makes " + std::to_string(cells.prod()) +
                                " cells, it must make 1 to 1e8");
  }
  reach_ = static_cast<int>(std::ceil(inflation / resolution));
  count_ = cells.matrix().cast<int>();
  blocked_.assign(static_cast<std::size_t>(cells.prod()), 0);
}

void CubeGrid::SetOccupied(const Eigen::Vector3d& p_W) {
  const CellIndex middle = CellOf(p_W);
  if (!Contains(middle)) return;
  const CellIndex reach = CellIndex::Constant(reach_);
  const CellIndex low = (middle - reach).cwiseMax(0);
  const CellIndex high = (middle + reach).cwiseMin(count_ - CellIndex::Ones());
  CellIndex cell;
  for (cell.z() = low.z(); cell.z() <= high.z(); ++cell.z()) {
    for (cell.y() = low.y(); cell.y() <= high.y(); ++cell.y()) {
      for (cell.x() = low.x(); cell.x() <= high.x(); ++cell.x()) blocked_[Address(cell)] = 1;
    }
  }
}

}  // namespace touchdown::planning
