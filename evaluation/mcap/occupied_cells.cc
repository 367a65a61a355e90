// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/occupied_cells.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace touchdown::evaluation {

void OccupiedCells::Apply(const MapChange& change) {
  const auto in_window = [&](const Cell& cell) {
    const planning::CellIndex from = planning::CellIndex(cell[2], cell[1], cell[0]) - change.origin;
    return from.minCoeff() >= 0 && (size_ - from).minCoeff() > 0;
  };
  // What the window left is forgotten.
  std::erase_if(cells_, [&](const Cell& cell) { return !in_window(cell); });
  for (const MapRun& run : change.runs) {
    for (int i = 0; i < run.count; ++i) {
      const Cell cell = {run.cell.z(), run.cell.y(), run.cell.x() + i};
      if (!in_window(cell)) {
        throw std::invalid_argument("its table map_change has cells outside of the map's window");
      }
      if (run.state == planning::CellState::kOccupied) {
        cells_.insert(cell);
      } else {
        cells_.erase(cell);
      }
    }
  }
}

std::vector<OccupiedCells::Cell> OccupiedCells::TakeNew() {
  std::vector<Cell> added;
  std::set_difference(cells_.begin(), cells_.end(), told_.begin(), told_.end(),
                      std::back_inserter(added));
  told_ = cells_;
  return added;
}

}  // namespace touchdown::evaluation
