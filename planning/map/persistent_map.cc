// SPDX-License-Identifier: BSD-3-Clause
// A block is filled from the octree when it is first touched, and is more recent from then on. Write copies the
// blocks back.

#include "touchdown/planning/map/persistent_map.h"

#include <algorithm>
#include <vector>

#include "planning/map/prior_tree.h"

namespace touchdown::planning {

struct PersistentMap::Impl {
  explicit Impl(const OccupancyMapOptions& o) : options(o), prior(o) {}

  std::unique_ptr<CellBlocks> NewBlocks() {
    return std::make_unique<CellBlocks>(
        [this](const CellIndex& corner, CellBlock* block) { prior.Fill(corner, block); });
  }
  /// The octree holds all of its 26 neighbours free, or they are ground.
  bool IsAmidFree(const CellIndex& cell) const {
    bool amid = true;
    ForEachCell({cell.array() - 1, cell.array() + 2}, [&](const CellIndex& near) {
      amid &= IsGround(near, options) || prior.LogOdds(near).value_or(0) < 0;
    });
    return amid;
  }

  OccupancyMapOptions options;
  PriorTree prior;
  std::unique_ptr<CellBlocks> blocks = NewBlocks();
  std::vector<CellValue> changes;  // of the window that is flushed
};

PersistentMap::PersistentMap(const OccupancyMapOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
PersistentMap::~PersistentMap() = default;
PersistentMap::PersistentMap(PersistentMap&&) noexcept = default;
PersistentMap& PersistentMap::operator=(PersistentMap&&) noexcept = default;

void PersistentMap::Recentre(const Eigen::Vector3d& p_W, OccupancyMap* map) {
  map->Recentre(p_W, impl_->blocks.get());
  for (const CellBox& box : map->entered()) Refill(box, map);
}

void PersistentMap::Refill(OccupancyMap* map) const {
  Refill({map->origin(), map->origin() + map->size()}, map);
}

void PersistentMap::Flush(OccupancyMap* map) {
  impl_->changes.clear();
  map->TakeChanges(&impl_->changes);
  for (const CellValue& value : impl_->changes) impl_->blocks->Put(value);
}

void PersistentMap::Refill(const CellBox& box, OccupancyMap* map) const {
  const CellIndex low = box.low.cwiseMax(-kKeyOffset);
  const CellIndex high = box.high.cwiseMin(kKeyOffset);
  if ((low.array() >= high.array()).any()) return;
  const auto block_of = [](int c) { return c >> CellBlock::kSideLog2; };
  const CellBox blocks = {low.unaryExpr(block_of),
                          (high.array() - 1).matrix().unaryExpr(block_of).array() + 1};
  ForEachCell(blocks, [&](const CellIndex& at) {
    const CellIndex corner = at * CellBlock::kSide;
    const CellBlock* block = impl_->blocks->Find(corner);
    if (block == nullptr && impl_->prior.Knows(corner)) {
      block = impl_->blocks->Make(corner);
    }
    if (block == nullptr) return;
    const CellBox cells = {corner.cwiseMax(low),
                           (corner.array() + CellBlock::kSide).matrix().cwiseMin(high)};
    ForEachCell(cells, [&](const CellIndex& cell) {
      if ((*block)[cell] != kUnknownLogOdds) map->Restore({cell, (*block)[cell]});
    });
  });
}

std::optional<std::int8_t> PersistentMap::LogOdds(const CellIndex& cell) const {
  if (!InTree(cell)) return std::nullopt;
  if (const CellBlock* block = impl_->blocks->Find(cell)) {
    if ((*block)[cell] == kUnknownLogOdds) return std::nullopt;
    return (*block)[cell];
  }
  return impl_->prior.LogOdds(cell);
}

bool PersistentMap::IsOccupied(const CellIndex& cell) const {
  const auto log_odds = LogOdds(cell);
  return log_odds && *log_odds >= impl_->prior.occupied();
}

std::size_t PersistentMap::size() const {
  std::size_t size = impl_->prior.size();
  impl_->blocks->ForEach([&](const CellValue&) { ++size; });
  return size;
}

void PersistentMap::Read(std::istream& in) {
  impl_->prior.Read(in);
  impl_->blocks = impl_->NewBlocks();
}

PriorCheck PersistentMap::CheckPrior() const {
  PriorCheck check;
  const int occupied = impl_->prior.occupied();
  impl_->prior.ForEachObstacle([&](const CellCube& cube) {
    for (int z = cube.low.z(); z < cube.low.z() + cube.side; ++z) {
      if (!IsGround({0, 0, z}, impl_->options))
        check.occupied += std::int64_t{cube.side} * cube.side;
    }
  });
  impl_->blocks->ForEachPut([&](const CellValue& sensed) {
    const auto said = impl_->prior.LogOdds(sensed.cell);
    if (!said || IsGround(sensed.cell, impl_->options)) return;
    if (*said >= occupied) {
      ++check.looked_at;
      if (sensed.log_odds < 0) check.gone.push_back(sensed.cell);
    } else if (*said < 0 && sensed.log_odds >= occupied && impl_->IsAmidFree(sensed.cell)) {
      check.appeared.push_back(sensed.cell);
    }
  });
  for (std::vector<CellIndex>* cells : {&check.gone, &check.appeared}) {
    std::sort(cells->begin(), cells->end(), [](const CellIndex& a, const CellIndex& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
  }
  return check;
}

std::vector<CellCube> PersistentMap::PriorObstacles(const CellBox& within) const {
  std::vector<CellCube> obstacles;
  impl_->prior.ForEachObstacle([&](const CellCube& cube) {
    const bool outside = ((cube.low.array() + cube.side <= within.low.array()) ||
                          (cube.low.array() >= within.high.array()))
                             .any();
    const CellIndex top = cube.low.array() + (cube.side - 1);
    if (!outside && !IsGround(top, impl_->options)) obstacles.push_back(cube);
  });
  return obstacles;
}

void PersistentMap::Write(std::ostream& out, MapFormat format) {
  impl_->blocks->ForEach([&](const CellValue& value) { impl_->prior.Put(value); });
  impl_->blocks = impl_->NewBlocks();
  impl_->prior.Write(out, format);
}

}  // namespace touchdown::planning
