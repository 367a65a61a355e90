// SPDX-License-Identifier: BSD-3-Clause
// Rows of the map's inflated grid, the floor, the ceiling and the barriers as words of bits.

#include "planning/search/blocked_bits.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {

namespace {

constexpr int kWord = 64;  // cells

}  // namespace

void BlockedBits::Reserve(const OccupancyMap& map) {
  if (map.size() == size_) return;
  number_ = 0;
  size_ = map.size();
  words_per_row_ = (size_.x() + kWord - 1) / kWord;
  const auto words = static_cast<std::size_t>(words_per_row_) *
                     static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z());
  words_.assign(words, 0);
  made_.assign(words, 0);
}

void BlockedBits::Begin(const FreeSpace& space, std::span<const Barrier> barriers) {
  Reserve(*space.map);
  space_ = space;
  barriers_ = barriers;
  const bool has_pad = space.pad_radius > 0.0;
  const double lowest = has_pad ? std::min(space.floor, space.pad_floor) : space.floor;
  z_begin_ = 0;
  z_end_ = size_.z();
  while (z_begin_ < z_end_ && TooLow(lowest, z_begin_)) ++z_begin_;
  while (z_begin_ < z_end_ && TooHigh(z_end_ - 1)) --z_end_;
  if (++number_ != 0) return;
  std::fill(made_.begin(), made_.end(), 0);  // wrapped around
  number_ = 1;
}

std::uint32_t BlockedBits::Around(const CellIndex& cell) {
  const int word = cell.x() / kWord, bit = cell.x() % kWord;
  std::uint32_t around = 0;
  for (int dz = -1; dz <= 1; ++dz) {
    const int z = cell.z() + dz;
    if (z < 0 || z >= size_.z()) continue;
    for (int dy = -1; dy <= 1; ++dy) {
      const int y = cell.y() + dy;
      if (y < 0 || y >= size_.y()) continue;
      std::uint64_t three = Word(y, z, word);
      if (bit > 0) {
        three >>= bit - 1;
      } else {
        three <<= 1;
        if (word > 0) three |= Word(y, z, word - 1) >> (kWord - 1);
      }
      if (bit == kWord - 1 && word + 1 < words_per_row_) {
        three |= (Word(y, z, word + 1) & 1u) << 2;
      }
      around |= static_cast<std::uint32_t>(three & 7u) << (9 * (dz + 1) + 3 * (dy + 1));
    }
  }
  return around;
}

/// The cells of a row from `first` on that are over the pad: only those within the strip's box need a test.
std::uint64_t BlockedBits::OverPad(const CellIndex& first, int count) const {
  const OccupancyMap& map = *space_.map;
  const Eigen::Vector2d reach =
      Eigen::Vector2d::Constant(space_.pad_radius + map.resolution());  // room for rounding
  const Eigen::Vector2d low = space_.pad_from.cwiseMin(space_.pad_to) - reach;
  const Eigen::Vector2d high = space_.pad_from.cwiseMax(space_.pad_to) + reach;
  const Eigen::Vector3d centre = map.CentreOf(first);
  std::uint64_t bits = 0;
  if (centre.y() < low.y() || centre.y() > high.y()) return bits;
  const auto place = [&](double x) {
    const double cells = (x - centre.x()) / map.resolution();
    return static_cast<int>(std::clamp(cells, -1.0, static_cast<double>(kWord)));
  };
  for (int i = std::max(0, place(low.x())); i < std::min(count, place(high.x()) + 1); ++i) {
    const bool over = space_.OverPad(map.CentreOf(first + CellIndex(i, 0, 0)));
    bits |= static_cast<std::uint64_t>(over) << i;
  }
  return bits;
}

/// The cells of a row that belong to the barrier: only those near its plane need a test.
std::uint64_t BlockedBits::Of(const Barrier& barrier, const CellIndex& first, int count) const {
  const OccupancyMap& map = *space_.map;
  const double from = DistanceAlong(barrier, map.CentreOf(first));
  const double step = map.resolution() * barrier.normal.x();           // from cell to cell
  const double reach = (kBarrierThickness + 1e-6) * map.resolution();  // room for rounding
  int begin = 0, end = count;
  if (std::abs(step) * count > reach) {
    const auto place = [&](double along) {
      return std::clamp((along - from) / step, -1.0, static_cast<double>(kWord));
    };
    const auto [low, high] = std::minmax({place(-reach), place(reach)});
    begin = std::max(0, static_cast<int>(std::floor(low)));
    end = std::min(count, static_cast<int>(std::ceil(high)) + 1);
  } else if (std::abs(from) > reach + std::abs(step) * count) {
    return 0;
  }
  std::uint64_t bits = 0;
  for (int i = begin; i < end; ++i) {
    const bool closed = Closes(barrier, map.CentreOf(first + CellIndex(i, 0, 0)), map.resolution());
    bits |= static_cast<std::uint64_t>(closed) << i;
  }
  return bits;
}

bool BlockedBits::TooLow(double floor, int z) const {
  const OccupancyMap& map = *space_.map;
  const double centre = map.CentreOf(map.origin() + CellIndex(0, 0, z)).z();
  return centre - 0.5 * map.resolution() < floor - FreeSpace::kLevelRounding;
}

bool BlockedBits::TooHigh(int z) const {
  const OccupancyMap& map = *space_.map;
  const double centre = map.CentreOf(map.origin() + CellIndex(0, 0, z)).z();
  return centre + 0.5 * map.resolution() > space_.ceiling + FreeSpace::kLevelRounding;
}

/// As FreeSpace::Blocked and the barriers, but for whole rows where possible.
std::uint64_t BlockedBits::Make(int y, int z, int word) const {
  const OccupancyMap& map = *space_.map;
  const CellIndex first = map.origin() + CellIndex(word * kWord, y, z);
  const int count = std::min(kWord, size_.x() - word * kWord);
  const std::uint64_t all = ~std::uint64_t{0} >> (kWord - count);
  if (z < z_begin_ || z >= z_end_) return all;
  const bool too_low = TooLow(space_.floor, z);
  const bool too_low_over_pad = space_.pad_radius > 0.0 ? TooLow(space_.pad_floor, z) : too_low;
  std::uint64_t bits = space_.ClosedRow(first, count);
  if (too_low != too_low_over_pad) {
    const std::uint64_t over = OverPad(first, count);
    bits |= too_low_over_pad ? over : all & ~over;
  }
  for (const Barrier& barrier : barriers_) bits |= Of(barrier, first, count);
  return bits;
}

}  // namespace touchdown::planning
