// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <vector>

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

/// What is occupied in an OctoMap file: cell i spans [i, i + 1) times the resolution.
struct OccupiedCells {
  double resolution = 0.1;  ///< [m]
  std::vector<CellIndex> cells;
};

/// Reads an OctoMap file of either format and of any resolution. A large leaf of the tree counts as the cells in it.
/// @throws std::invalid_argument that says what is wrong: no such file, mangled, more than five million cells.
OccupiedCells ReadOccupiedCells(std::istream& in);

}  // namespace touchdown::planning
