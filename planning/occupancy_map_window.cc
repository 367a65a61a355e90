// SPDX-License-Identifier: BSD-3-Clause
// Moving the window of the rolling map: what leaves is handed out and forgotten while its ball can
// still be taken back; what enters takes over addresses of what left, and its inflation is counted
// anew from the obstacles that stay.

#include <algorithm>

#include "touchdown/planning/occupancy_map.h"

namespace touchdown::planning {

// Calls visit(cell, address) for the cells of a box in the window. Slabs are large and mostly empty,
// so that finding a row's address once counts.
template <class Visit>
void OccupancyMap::ForEachAddress(const CellBox& box, Visit&& visit) const {
  for (int z = box.low.z(); z < box.high.z(); ++z) {
    for (int y = box.low.y(); y < box.high.y(); ++y) {
      const std::size_t row = RowAddress(y, z);
      for (int x = box.low.x(); x < box.high.x(); ++x) {
        visit(CellIndex(x, y, z), row | static_cast<std::size_t>(x & mask_.x()));
      }
    }
  }
}

void OccupancyMap::Recentre(const Eigen::Vector3d& p_W) {
  flips_.clear();
  left_.clear();
  entered_.clear();
  const CellIndex target = CellOf(p_W) - size_ / 2;
  const CellIndex offset = (target - origin_).cwiseAbs();
  // A shift costs whole slabs of cells, so the window waits until there is one to move.
  if (((offset - size_ / 16).array() >= 0).any()) MoveWindow(target);
}

void OccupancyMap::MoveWindow(const CellIndex& origin) {
  flips_.clear();
  left_.clear();
  const CellIndex shift = origin - origin_;
  const CellBox old = {origin_, origin_ + size_};
  EdgeSlabs(old, -shift, &slabs_);
  for (const CellBox& slab : slabs_) {
    ForEachAddress(slab, [&](const CellIndex& cell, std::size_t address) {
      if (cells_[address].log_odds != kUnknown) Forget(cell, &cells_[address]);
    });
  }

  origin_ = origin;
  const CellBox window = {origin_, origin_ + size_};
  EdgeSlabs(window, shift, &entered_);
  for (const CellBox& slab : entered_) {
    for (int z = slab.low.z(); z < slab.high.z(); ++z) {
      for (int y = slab.low.y(); y < slab.high.y(); ++y) {
        ClearRow(y, z, slab.low.x(), slab.high.x());
      }
    }
  }
  CellIndex reach;
  for (int c = 0; c < 3; ++c) reach[c] = (shift[c] > 0) - (shift[c] < 0);
  EdgeSlabs(window, shift + ball_reach_ * reach, &slabs_);
  for (const CellBox& slab : slabs_) {
    ForEachAddress(slab, [&](const CellIndex& cell, std::size_t address) {
      if (Blocks(cells_[address])) CountInflation(cell, old);
    });
  }
}

void OccupancyMap::Forget(const CellIndex& cell, Cell* stored) {
  if (stored->changed && !stored->doubtful) left_.push_back({cell, stored->log_odds});
  Set(cell, Cell{});
  SetObservedFree(cell, false);
  stored->changed = false;
}

// Adds the ball of an obstacle to the cells that were not in the old window.
void OccupancyMap::CountInflation(const CellIndex& cell, const CellBox& but_for) {
  for (const BallRow& row : ball_) {
    const int y = cell.y() + row.y, z = cell.z() + row.z;
    const int begin = cell.x() - row.half, end = cell.x() + row.half + 1;
    const bool new_row = y < but_for.low.y() || y >= but_for.high.y() || z < but_for.low.z() ||
                         z >= but_for.high.z();
    AddToRow(y, z, begin, new_row ? end : std::min(end, but_for.low.x()), 1);
    if (!new_row) AddToRow(y, z, std::max(begin, but_for.high.x()), end, 1);
  }
}

void OccupancyMap::Restore(const CellValue& value) {
  if (!InWindow(value.cell)) return;
  const std::int8_t log_odds = std::clamp(value.log_odds, min_, max_);
  const double top = (value.cell.z() + 1) * options_.resolution;
  if (log_odds >= 0 && top <= options_.ground_height) return;
  Cell restored;
  restored.log_odds = log_odds;
  restored.hit_range = 0;  // from where it was hit is forgotten: only a sharp look outweighs it
  Set(value.cell, restored);
  cells_[Address(value.cell)].changed = false;
}

void OccupancyMap::TakeChanges(std::vector<CellValue>* changes) {
  ForEachAddress({origin_, origin_ + size_}, [&](const CellIndex& cell, std::size_t address) {
    Cell& stored = cells_[address];
    if (!stored.changed || stored.doubtful || stored.log_odds == kUnknown) return;
    changes->push_back({cell, stored.log_odds});
    stored.changed = false;
  });
}

void OccupancyMap::CopyStates(std::vector<CellState>* states) const {
  states->resize(cells_.size());
  CellState* out = states->data();
  ForEachAddress({origin_, origin_ + size_}, [&](const CellIndex& cell, std::size_t address) {
    const CellState free = IsObservedFree(cell) ? CellState::kFree : CellState::kUnknown;
    *out++ = Blocks(cells_[address]) ? CellState::kOccupied : free;
  });
}

}  // namespace touchdown::planning
