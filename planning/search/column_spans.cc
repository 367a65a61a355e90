// SPDX-License-Identifier: BSD-3-Clause
// A span begins or ends where a bit changes from one layer to the next: equal layers cost nothing.

#include "planning/search/column_spans.h"

#include <algorithm>
#include <bit>

namespace touchdown::planning {

void ColumnSpans::Reserve(const OccupancyMap& map) {
  blocked_.Reserve(map);
  if (size_ == map.size().head<2>()) return;
  size_ = map.size().head<2>();
  tiles_per_row_ = (size_.x() + kTile - 1) / kTile;
  const auto columns = static_cast<std::size_t>(size_.prod());
  spans_.assign(columns * kMost, {});
  count_.assign(columns, 0);
  made_.assign(static_cast<std::size_t>(tiles_per_row_) * static_cast<std::size_t>(size_.y()), 0);
  number_ = 0;
}

void ColumnSpans::Begin(const FreeSpace& space, std::span<const Barrier> barriers) {
  Reserve(*space.map);
  blocked_.Begin(space, barriers);
  if (++number_ != 0) return;
  std::fill(made_.begin(), made_.end(), 0);  // wrapped around
  number_ = 1;
}

int ColumnSpans::IdAt(const CellIndex& cell) {
  const int count = Count(cell.x(), cell.y());
  for (int id = 0; id < count; ++id) {
    if (At(cell.x(), cell.y(), id).Holds(cell.z())) return id;
  }
  return -1;
}

void ColumnSpans::Make(int word, int y) {
  const int first = word * kTile;
  const int count = std::min(kTile, size_.x() - first);
  const int row = y * size_.x() + first, columns = size_.prod();
  std::int8_t* const spans_of = &count_[static_cast<std::size_t>(row)];
  std::fill_n(spans_of, count, std::int8_t{0});
  const auto span = [&](int i, int id) -> FreeSpan& {
    return spans_[static_cast<std::size_t>(id * columns + row + i)];
  };
  const std::uint64_t all = ~std::uint64_t{0} >> (kTile - count);
  std::uint64_t below = all, full = 0;  // full: has kMost spans, and they have ended
  const int end = blocked_.z_end();
  for (int z = blocked_.z_begin(); z <= end; ++z) {
    const std::uint64_t here = z < end ? blocked_.Word(y, z, word) : all;
    for (std::uint64_t changed = (here ^ below) & all & ~full; changed != 0;
         changed &= changed - 1) {
      const int i = std::countr_zero(changed);
      if ((here >> i & 1u) == 0) {
        span(i, spans_of[i]++).low = static_cast<std::int16_t>(z);
      } else {
        span(i, spans_of[i] - 1).high = static_cast<std::int16_t>(z - 1);
        if (spans_of[i] == kMost) full |= std::uint64_t{1} << i;
      }
    }
    below = here;
  }
  made_[static_cast<std::size_t>(y * tiles_per_row_ + word)] = number_;
}

}  // namespace touchdown::planning
