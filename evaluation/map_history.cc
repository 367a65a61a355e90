// SPDX-License-Identifier: BSD-3-Clause
// Rows of the window are compared whole first: most of them are the same from step to step.
#include "touchdown/evaluation/map_history.h"

#include <algorithm>
#include <cstring>

namespace touchdown::evaluation {
namespace {

using planning::CellIndex;
using planning::CellState;

// Appends the runs of cells in which a row of `count` cells from `first` on differs.
void CompareRow(const CellState* before, const CellState* after, int count, const CellIndex& first,
                std::vector<MapRun>* runs) {
  for (int i = 0; i < count;) {
    if (before[i] == after[i]) {
      ++i;
      continue;
    }
    MapRun run{first + i * CellIndex::UnitX(), 0, after[i]};
    // A cell that had the state already may stand inside a run: fewer runs say the same.
    for (; i < count && after[i] == run.state; ++i) ++run.count;
    runs->push_back(run);
  }
}

}  // namespace

const char* ToString(CellState state) {
  switch (state) {
    case CellState::kUnknown:
      return "unknown";
    case CellState::kFree:
      return "free";
    case CellState::kOccupied:
      return "occupied";
  }
  return "unknown";
}

MapChange MapRecorder::Take(const planning::OccupancyMap& map) {
  MapChange change;
  change.origin = map.origin();
  map.CopyStates(&now_);
  const CellIndex size = map.size();
  const std::vector<CellState> unknown(static_cast<std::size_t>(size.x()), CellState::kUnknown);
  std::vector<CellState> row(unknown);
  // Cells of a row that were in the window before.
  const CellIndex shift = change.origin - origin_;
  const int from = std::clamp(-shift.x(), 0, size.x());
  const int to = std::clamp(size.x() - shift.x(), 0, size.x());
  const CellState* after = now_.data();
  for (int z = 0; z < size.z(); ++z) {
    for (int y = 0; y < size.y(); ++y, after += size.x()) {
      const int old_y = y + shift.y(), old_z = z + shift.z();
      const bool known = !states_.empty() && old_y >= 0 && old_y < size.y() && old_z >= 0 &&
                         old_z < size.z() && from < to;
      const CellState* before = unknown.data();
      if (known) {
        row = unknown;
        const auto old_row = states_.begin() +
                             (static_cast<std::ptrdiff_t>(old_z) * size.y() + old_y) * size.x() +
                             shift.x();
        std::copy(old_row + from, old_row + to, row.begin() + from);
        before = row.data();
      }
      if (std::memcmp(before, after, static_cast<std::size_t>(size.x())) == 0) continue;
      CompareRow(before, after, size.x(), change.origin + CellIndex(0, y, z), &change.runs);
    }
  }
  origin_ = change.origin;
  states_.swap(now_);
  return change;
}

void Apply(const MapChange& change, planning::OccupancyMap* map) {
  if (change.origin != map->origin()) map->MoveWindow(change.origin);
  for (const MapRun& run : change.runs) {
    for (int i = 0; i < run.count; ++i) {
      map->SetState(run.cell + i * CellIndex::UnitX(), run.state);
    }
  }
}

}  // namespace touchdown::evaluation
