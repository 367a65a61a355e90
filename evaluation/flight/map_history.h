// SPDX-License-Identifier: BSD-3-Clause
// The changes of a rolling map from one replanning step to the next.
#pragma once

#include <cstdint>
#include <vector>

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::evaluation {

/// "unknown", "free" or "occupied".
const char* ToString(planning::CellState state);

/// `count` cells from `cell` on along +x that took on one state.
struct MapRun {
  planning::CellIndex cell = planning::CellIndex::Zero();
  int count = 0;
  planning::CellState state = planning::CellState::kUnknown;
};

/// The changes since the step before. Cells that the window left are forgotten. New cells of the
/// window are unknown unless a run says otherwise.
struct MapChange {
  planning::CellIndex origin = planning::CellIndex::Zero();  ///< lowest cell of the window
  std::vector<MapRun> runs;
};

/// Compares a map with itself as it was at the last call: with one of unknown cells at the first.
class MapRecorder {
 public:
  MapChange Take(const planning::OccupancyMap& map);

 private:
  /// A window's cells as bits: rows along x from its lowest cell on, each in whole words.
  struct States {
    std::vector<std::uint64_t> free, occupied;
  };

  planning::CellIndex origin_ = planning::CellIndex::Zero();
  States states_, now_;
};

/// Brings `map` to the next step. It then answers a planner as the recorded one did.
void Apply(const MapChange& change, planning::OccupancyMap* map);

}  // namespace touchdown::evaluation
