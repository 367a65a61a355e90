// SPDX-License-Identifier: BSD-3-Clause
// A hash table of blocks whose nodes lie one after the other in one piece of memory. Storing what a
// window forgets then needs no allocation, and copies nothing that is stored already.

#include "touchdown/planning/map/cell_blocks.h"

#include <utility>

namespace touchdown::planning {

namespace {

constexpr int kAxisBits = 16 - CellBlock::kSideLog2;  // of a block's place along an axis
static_assert(2 * CellBlocks::kReach >> CellBlock::kSideLog2 == 1 << kAxisBits);

#ifdef __cpp_lib_memory_resource
// Of a node of the table: a block with its key and what links it.
constexpr std::size_t kNodeBytes = sizeof(CellBlock) + 4 * sizeof(void*);
#endif

}  // namespace

#ifdef __cpp_lib_memory_resource
CellBlocks::CellBlocks(Fill fill)
    : fill_(std::move(fill)),
      room_(std::make_unique_for_overwrite<std::byte[]>(kReserved * (kNodeBytes + sizeof(void*)))),
      memory_(room_.get(), kReserved * (kNodeBytes + sizeof(void*))),
      blocks_(&memory_) {
  blocks_.reserve(kReserved);
}
#else
CellBlocks::CellBlocks(Fill fill) : fill_(std::move(fill)) { blocks_.reserve(kReserved); }
#endif

CellBlocks::Key CellBlocks::KeyOf(const CellIndex& cell) {
  const auto along = [](int c) { return static_cast<Key>(c + kReach) >> CellBlock::kSideLog2; };
  return (along(cell.z()) << kAxisBits | along(cell.y())) << kAxisBits | along(cell.x());
}

CellIndex CellBlocks::LowOf(Key key) {
  const auto along = [&](int axis) {
    constexpr Key kMask = (Key{1} << kAxisBits) - 1;
    return static_cast<int>((key >> axis * kAxisBits & kMask) << CellBlock::kSideLog2) - kReach;
  };
  return {along(0), along(1), along(2)};
}

void CellBlocks::Put(const CellValue& value) {
  const CellIndex& cell = value.cell;
  if ((cell.array() < -kReach).any() || (cell.array() >= kReach).any()) return;
  Make(cell)->Put(value);
}

const CellBlock* CellBlocks::Find(const CellIndex& cell) const {
  const auto found = blocks_.find(KeyOf(cell));
  return found != blocks_.end() ? &found->second : nullptr;
}

CellBlock* CellBlocks::Make(const CellIndex& cell) {
  const Key key = KeyOf(cell);
  Latest& latest = latest_[key % latest_.size()];
  if (latest.key == key) return latest.block;
  const auto [place, is_new] = blocks_.try_emplace(key);
  if (is_new && fill_) fill_(LowOf(key), &place->second);
  latest = {key, &place->second};
  return latest.block;
}

}  // namespace touchdown::planning
