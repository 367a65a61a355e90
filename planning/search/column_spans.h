// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planning/search/blocked_bits.h"

namespace touchdown::planning {

/// A free stretch of a column, its lowest and its highest cell, counted from the window's lowest one.
struct FreeSpan {
  std::int16_t low = 0;
  std::int16_t high = 0;

  bool Holds(int z) const { return z >= low && z <= high; }
};

/// The free stretches of the columns of a window: most have one, from the floor to the ceiling. Made 64
/// columns at a time, at the first use of one of them.
class ColumnSpans {
 public:
  /// Of a column at most; those above count as blocked.
  static constexpr int kMost = 6;

  /// Makes room for this map's window, which Begin does otherwise.
  void Reserve(const OccupancyMap& map);

  /// From now on of this space and these barriers, which must outlive the calls of At. Allocates only to
  /// grow to a high-water mark.
  void Begin(const FreeSpace& space, std::span<const Barrier> barriers);

  /// Columns of the window along x and y.
  const Eigen::Vector2i& size() const { return size_; }
  /// Cells of the window along z.
  int levels() const { return blocked_.size().z(); }

  /// How many spans the column at x and y has. These count from the window's lowest cell.
  int Count(int x, int y) {
    const auto tile = static_cast<std::size_t>(y * tiles_per_row_ + x / kTile);
    if (made_[tile] != number_) Make(x / kTile, y);
    return count_[static_cast<std::size_t>(y * size_.x() + x)];
  }

  /// They count from the lowest to the highest. @pre id < Count(x, y), which was called before.
  const FreeSpan& At(int x, int y, int id) const {
    return spans_[static_cast<std::size_t>((id * size_.y() + y) * size_.x() + x)];
  }

  /// Which span of its column holds a cell; -1: it is blocked.
  int IdAt(const CellIndex& cell);

 private:
  static constexpr int kTile = 64;  // columns along x

  void Make(int word, int y);

  BlockedBits blocked_;
  Eigen::Vector2i size_ = Eigen::Vector2i::Zero();
  int tiles_per_row_ = 0;
  // The first spans of all columns, then the second ones: neighbours are next to each other.
  std::vector<FreeSpan> spans_;
  std::vector<std::int8_t> count_;
  std::vector<std::uint32_t> made_;  // tiles, with which number; 0: never
  std::uint32_t number_ = 0;
};

}  // namespace touchdown::planning
