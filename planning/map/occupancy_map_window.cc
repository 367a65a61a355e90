// SPDX-License-Identifier: BSD-3-Clause
// Moving the window of the rolling map. Cells that leave are put in memory and forgotten while
// their ball can still be subtracted. Cells that enter take over addresses of cells that left.
// Their inflation is counted anew from the obstacles that stay.

#include <algorithm>
#include <bit>

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

namespace {

constexpr int kSlice = 4;  // so far off its centre the window moves, along one axis [cells] ...
constexpr int kJump = 16;  // ... and so far off along all

}  // namespace

void OccupancyMap::Recentre(const Eigen::Vector3d& p_W, CellBlocks* memory) {
  entered_.clear();
  if (!HasIndex(p_W)) return;  // nowhere: the window stays
  const CellIndex target = CellOf(p_W) - size_ / 2;
  const CellIndex offset = (target - origin_).cwiseAbs();
  const CellIndex far = (size_ / 8).cwiseMin(kJump);
  if (((offset - far).array() >= 0).any()) return MoveWindow(target, memory);
  // In slices: thin slabs of one axis at a time, so that no frame pays for many.
  int axis = 0;
  if (offset.maxCoeff(&axis) < kSlice) return;
  CellIndex next = origin_;
  next[axis] = target[axis];
  MoveWindow(next, memory);
}

void OccupancyMap::MoveWindow(const CellIndex& origin, CellBlocks* memory) {
  const CellIndex shift = origin - origin_;
  const CellBox old = window();
  const CellBox stays = {old.low.cwiseMax(origin), old.high.cwiseMin(origin + size_)};
  EdgeSlabs(old, -shift, &slabs_);
  for (const CellBox& slab : slabs_) {
    ForEachStretch(slab, [&](const Stretch& s) {
      std::uint64_t known = (known_[s.word] & s.mask()) >> s.shift;
      if (known == 0) return;
      for (; known != 0; known &= known - 1) {
        Forget(s.first + std::countr_zero(known) * CellIndex::UnitX(), stays, memory);
      }
      for (Bits* bits : {&known_, &free_, &obstacles_, &settled_}) (*bits)[s.word] &= ~s.mask();
    });
  }

  origin_ = origin;
  EdgeSlabs(window(), shift, &entered_);
  for (const CellBox& slab : entered_) {
    ForEachStretch(slab, [&](const Stretch& s) {
      if ((blocked_[s.word] & s.mask()) == 0) return;
      std::fill_n(&inflation_[s.address], s.count, 0);
      blocked_[s.word] &= ~s.mask();
    });
  }
  CellIndex reach;
  for (int c = 0; c < 3; ++c) reach[c] = (shift[c] > 0) - (shift[c] < 0);
  EdgeSlabs(window(), shift + ball_reach_ * reach, &slabs_);
  for (const CellBox& slab : slabs_) {
    ForEachSet(obstacles_, slab, [&](const CellIndex& cell) {
      for (const CellBox& box : entered_) Inflate(cell, 1, box);
    });
  }
}

/// A cell that leaves. Of its ball only the part that stays has to be subtracted.
void OccupancyMap::Forget(const CellIndex& cell, const CellBox& stays, CellBlocks* memory) {
  Cell& stored = cells_[Address(cell)];
  if (memory != nullptr && stored.changed && !stored.doubtful) {
    memory->Put({cell, stored.log_odds});
  }
  if (Blocks(stored)) Inflate(cell, -1, stays);
  stored = Cell{};
}

void OccupancyMap::Restore(const CellValue& value) {
  if (!InWindow(value.cell)) return;
  const std::int8_t log_odds = std::clamp(value.log_odds, min_, max_);
  if (log_odds >= 0 && IsGround(value.cell, options_)) return;
  Cell restored;
  restored.log_odds = log_odds;
  restored.hit_range = 0;  // from where it was hit is forgotten: only a sharp look outweighs it
  Set(value.cell, restored);
  cells_[Address(value.cell)].changed = false;
}

void OccupancyMap::TakeChanges(std::vector<CellValue>* changes) {
  ForEachSet(known_, window(), [&](const CellIndex& cell) {
    Cell& stored = cells_[Address(cell)];
    if (!stored.changed || stored.doubtful) return;
    changes->push_back({cell, stored.log_odds});
    stored.changed = false;
  });
}

void OccupancyMap::CopyStates(std::vector<CellState>* states) const {
  states->assign(blocked_.size() * static_cast<std::size_t>(std::min(kWord, size_.x())),
                 CellState::kUnknown);
  const auto put = [&](const CellIndex& cell, CellState state) {
    const CellIndex at = cell - origin_;
    (*states)[(static_cast<std::size_t>(at.z()) << options_.size_log2.y() |
               static_cast<std::size_t>(at.y()))
                  << options_.size_log2.x() |
              static_cast<std::size_t>(at.x())] = state;
  };
  ForEachSet(free_, window(), [&](const CellIndex& cell) { put(cell, CellState::kFree); });
  ForEachSet(obstacles_, window(), [&](const CellIndex& cell) { put(cell, CellState::kOccupied); });
}

}  // namespace touchdown::planning
