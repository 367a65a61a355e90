// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/blocked_bits.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {

namespace {

constexpr int kWord = 64;  // cells

}  // namespace

void BlockedBits::Reserve(const OccupancyMap& map) {
  if (map.size() == size_) return;
  size_ = map.size();
  words_per_row_ = (size_.x() + kWord - 1) / kWord;
  const auto words = static_cast<std::size_t>(words_per_row_) *
                     static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z());
  words_.assign(words, 0);
  made_.assign(words, 0);
  number_ = 0;
}

void BlockedBits::Begin(const FreeSpace& space, std::span<const Barrier> barriers) {
  Reserve(*space.map);
  space_ = space;
  barriers_ = barriers;
  if (++number_ == 0) {  // wrapped around
    std::fill(made_.begin(), made_.end(), 0);
    number_ = 1;
  }
}

std::uint32_t BlockedBits::Around(const CellIndex& cell) {
  const int word = cell.x() / kWord, bit = cell.x() % kWord;
  std::uint32_t around = 0;
  for (int z = -1; z <= 1; ++z) {
    if (cell.z() + z < 0 || cell.z() + z >= size_.z()) continue;
    for (int y = -1; y <= 1; ++y) {
      if (cell.y() + y < 0 || cell.y() + y >= size_.y()) continue;
      const int row = (cell.z() + z) * size_.y() + cell.y() + y;
      std::uint64_t three = Word(row, word);
      if (bit > 0) {
        three >>= bit - 1;
      } else {
        three <<= 1;
        if (word > 0) three |= Word(row, word - 1) >> (kWord - 1);
      }
      if (bit == kWord - 1 && word + 1 < words_per_row_) three |= (Word(row, word + 1) & 1u) << 2;
      around |= static_cast<std::uint32_t>(three & 7u) << (9 * (z + 1) + 3 * (y + 1));
    }
  }
  return around;
}

/// What FreeSpace::Blocked and the barriers say, with as much as possible said of whole rows.
void BlockedBits::Make(int row, int word) {
  const OccupancyMap& map = *space_.map;
  const CellIndex first = map.origin() + CellIndex(word * kWord, row % size_.y(), row / size_.y());
  const int count = std::min(kWord, size_.x() - word * kWord);
  std::uint64_t bits = map.BlockedRow(first, count);
  Eigen::Vector3d centre = map.CentreOf(first);
  const double resolution = map.resolution();
  const auto add_where = [&](const auto& blocked) {
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d at = map.CentreOf(first + CellIndex(i, 0, 0));
      if (blocked(at)) bits |= std::uint64_t{1} << i;
    }
  };
  const double low =
      space_.pad_radius > 0.0 ? std::min(space_.floor, space_.pad_floor) : space_.floor;
  const double high =
      space_.pad_radius > 0.0 ? std::max(space_.floor, space_.pad_floor) : space_.floor;
  if (centre.z() > space_.ceiling || centre.z() < low) {
    bits = ~std::uint64_t{0} >> (kWord - count);
  } else if (centre.z() < high) {
    add_where([&](const Eigen::Vector3d& at) { return at.z() < space_.FloorAt(at); });
  }
  for (const Barrier& barrier : barriers_) {
    const double from = DistanceAlong(barrier, centre);
    const double to = from + (count - 1) * resolution * barrier.normal.x();
    const double reach = kBarrierThickness * resolution;
    if (std::min(from, to) > reach || std::max(from, to) < -reach) continue;
    add_where([&](const Eigen::Vector3d& at) { return Closes(barrier, at, resolution); });
  }
  const auto i = static_cast<std::size_t>(row * words_per_row_ + word);
  words_[i] = bits;
  made_[i] = number_;
}

}  // namespace touchdown::planning
