// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <version>
#ifdef __cpp_lib_memory_resource
#include <memory_resource>
#endif

#include "touchdown/planning/map/cell_box.h"

namespace touchdown::planning {

/// What was observed of a cell.
struct CellValue {
  CellIndex cell;
  std::int8_t log_odds;  ///< in steps of OccupancyMap::kLogOddsStep
};

/// Log-odds of a cell that was never observed. Out of every clamp, so that no update can reach it.
inline constexpr std::int8_t kUnknownLogOdds = -128;

/// 8 x 8 x 8 cells whose indices differ in the lowest three bits only.
struct CellBlock {
  static constexpr int kSideLog2 = 3;
  static constexpr int kSide = 1 << kSideLog2;

  CellBlock() { log_odds.fill(kUnknownLogOdds); }

  std::int8_t& operator[](const CellIndex& cell) { return log_odds[Place(cell)]; }
  std::int8_t operator[](const CellIndex& cell) const { return log_odds[Place(cell)]; }
  /// It was put there, not filled in.
  bool WasPut(const CellIndex& cell) const { return was_put[Place(cell)]; }
  void Put(const CellValue& value) {
    log_odds[Place(value.cell)] = value.log_odds;
    was_put[Place(value.cell)] = true;
  }

  std::array<std::int8_t, kSide * kSide * kSide> log_odds;
  std::bitset<kSide * kSide * kSide> was_put;

 private:
  static std::size_t Place(const CellIndex& cell) {
    constexpr int kLow = kSide - 1;
    return static_cast<std::size_t>(
        ((cell.z() & kLow) << kSideLog2 | (cell.y() & kLow)) << kSideLog2 | (cell.x() & kLow));
  }
};

/// Log-odds of cells anywhere, in blocks. Cells that leave a window are dense, so one look-up of a
/// block serves many cells. Has room for kReserved blocks from the start, and allocates beyond.
class CellBlocks {
 public:
  static constexpr int kReach =
      32768;  ///< cells that are farther from the world's origin are not kept
  static constexpr std::size_t kReserved = 1 << 13;

  /// Gives what is known of a block's cells before any was put. All are unknown when it is called.
  using Fill = std::function<void(const CellIndex& low, CellBlock* block)>;

  explicit CellBlocks(Fill fill = nullptr);

  void Put(const CellValue& value);

  /// The block that holds the cell; nullptr: nothing was put there.
  const CellBlock* Find(const CellIndex& cell) const;
  /// The same, made if it is not there. The cell must be within kReach.
  CellBlock* Make(const CellIndex& cell);

  /// Calls visit(value) for every cell that is known.
  template <class Visit>
  void ForEach(Visit&& visit) const;
  /// The same for those that were put there, as they are now.
  template <class Visit>
  void ForEachPut(Visit&& visit) const;

 private:
  using Key = std::uint64_t;
  static Key KeyOf(const CellIndex& cell);
  static CellIndex LowOf(Key key);

  // The latest blocks, by where they are along x. A slab is traversed in rows, which return to the
  // same blocks again and again.
  struct Latest {
    Key key = ~Key{0};
    CellBlock* block = nullptr;
  };

  Fill fill_;
  std::array<Latest, 64> latest_;
#ifdef __cpp_lib_memory_resource
  std::unique_ptr<std::byte[]> room_;
  std::pmr::monotonic_buffer_resource memory_;
  std::pmr::unordered_map<Key, CellBlock> blocks_;
#else  // the library of the browsers' compiler: each block is an allocation
  std::unordered_map<Key, CellBlock> blocks_;
#endif
};

template <class Visit>
void CellBlocks::ForEach(Visit&& visit) const {
  for (const auto& entry : blocks_) {
    const CellBlock& block = entry.second;
    const CellIndex low = LowOf(entry.first);
    ForEachCell({low, low.array() + CellBlock::kSide}, [&](const CellIndex& cell) {
      if (block[cell] != kUnknownLogOdds) visit(CellValue{cell, block[cell]});
    });
  }
}

template <class Visit>
void CellBlocks::ForEachPut(Visit&& visit) const {
  for (const auto& entry : blocks_) {
    const CellBlock& block = entry.second;
    if (block.was_put.none()) continue;
    const CellIndex low = LowOf(entry.first);
    ForEachCell({low, low.array() + CellBlock::kSide}, [&](const CellIndex& cell) {
      if (block.WasPut(cell)) visit(CellValue{cell, block[cell]});
    });
  }
}

}  // namespace touchdown::planning
