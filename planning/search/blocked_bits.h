// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planning/search/barrier.h"
#include "touchdown/planning/certify/free_space.h"

namespace touchdown::planning {

/// The blocked cells of a window as bits, 64 along x to a word. A word is made at its first use. A search needs the
/// same cell from up to 26 sides, and only where it comes.
class BlockedBits {
 public:
  /// Makes room for this map's window, which Begin does otherwise.
  void Reserve(const OccupancyMap& map);

  /// From now on for this space and these barriers, which must outlive the calls of Word and Around. Allocates only
  /// to grow to a high-water mark.
  void Begin(const FreeSpace& space, std::span<const Barrier> barriers);

  /// Cells of the window.
  const CellIndex& size() const { return size_; }
  /// Below the first of these layers and from the second one on all cells are blocked, by floor and ceiling.
  int z_begin() const { return z_begin_; }
  int z_end() const { return z_end_; }

  /// The cells 64 `word` to 64 `word` + 63 of the row at y and z, counted from the window's lowest one. Bits
  /// beyond the window are not set.
  std::uint64_t Word(int y, int z, int word) {
    const auto i = static_cast<std::size_t>((y * words_per_row_ + word) * size_.z() + z);
    if (made_[i] != number_) {
      words_[i] = Make(y, z, word);
      made_[i] = number_;
    }
    return words_[i];
  }

  /// The 3 x 3 x 3 cells around a cell, counted from the window's lowest one. The cell at the offset
  /// (x, y, z) has the bit 9 (z + 1) + 3 (y + 1) + x + 1. Out of the window: not set.
  std::uint32_t Around(const CellIndex& cell);

 private:
  std::uint64_t Make(int y, int z, int word) const;
  bool TooLow(double floor, int z) const;
  bool TooHigh(int z) const;
  std::uint64_t OverPad(const CellIndex& first, int count) const;
  std::uint64_t Of(const Barrier& barrier, const CellIndex& first, int count) const;

  FreeSpace space_;
  std::span<const Barrier> barriers_;
  CellIndex size_ = CellIndex::Zero();
  int words_per_row_ = 0;
  int z_begin_ = 0, z_end_ = 0;
  // One above the other, as a column is read.
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> made_;  // with which number; 0: never
  std::uint32_t number_ = 0;
};

}  // namespace touchdown::planning
