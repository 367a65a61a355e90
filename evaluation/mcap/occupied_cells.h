// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <set>
#include <vector>

#include "evaluation/flight/map_history.h"

namespace touchdown::evaluation {

/// The occupied cells of a recorded map, before inflation, followed from step to step.
class OccupiedCells {
 public:
  using Cell = std::array<int, 3>;  ///< z, y, x
  using Cells = std::set<Cell>;

  /// @param size of the map's window [cells].
  explicit OccupiedCells(planning::CellIndex size) : size_(std::move(size)) {}

  /// Brings them to the next step. @throws std::invalid_argument for cells outside of the window, with words that go on from the
  /// record's name.
  void Apply(const MapChange& change);

  const Cells& all() const { return cells_; }

  /// Those that are occupied now and were not at the last call.
  std::vector<Cell> TakeNew();

 private:
  planning::CellIndex size_;
  Cells cells_, told_;
};

}  // namespace touchdown::evaluation
