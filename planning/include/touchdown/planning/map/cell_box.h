// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <Eigen/Core>

namespace touchdown::planning {

using CellIndex = Eigen::Vector3i;  ///< cell of the unbounded lattice: floor(p / resolution)

/// The cells [low, high).
struct CellBox {
  CellIndex low, high;
};

/// Calls visit(cell) for every cell of the box, along x first.
template <class Visit>
void ForEachCell(const CellBox& box, Visit&& visit) {
  CellIndex cell;
  for (cell.z() = box.low.z(); cell.z() < box.high.z(); ++cell.z()) {
    for (cell.y() = box.low.y(); cell.y() < box.high.y(); ++cell.y()) {
      for (cell.x() = box.low.x(); cell.x() < box.high.x(); ++cell.x()) visit(cell);
    }
  }
}

/// The box's cells within |thickness| of its upper (positive) or lower end on any axis, as disjoint
/// boxes, at most three.
inline void EdgeSlabs(CellBox box, const Eigen::Vector3i& thickness, std::vector<CellBox>* slabs) {
  slabs->clear();
  for (int axis = 0; axis < 3; ++axis) {
    const int n = std::min(std::abs(thickness[axis]), box.high[axis] - box.low[axis]);
    if (n == 0) continue;
    CellBox slab = box;
    if (thickness[axis] > 0) {
      slab.low[axis] = box.high[axis] -= n;
    } else {
      slab.high[axis] = box.low[axis] += n;
    }
    slabs->push_back(slab);
    if (box.low[axis] == box.high[axis]) return;  // nothing is left
  }
}

}  // namespace touchdown::planning
