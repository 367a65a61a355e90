// SPDX-License-Identifier: BSD-3-Clause
// Rows of the map's inflated grid, the floor, the ceiling and the barriers as words of bits; and of these
// the blocks of 2 x 2 x 2 cells: four rows laid over each other, then neighbouring bits.

#include "touchdown/planning/blocked_bits.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {

namespace {

constexpr int kWord = 64;  // cells

/// The bits at even places of (bits | bits >> 1), brought together in the lower half.
std::uint64_t PairsToBits(std::uint64_t bits) {
  bits = (bits | bits >> 1) & 0x5555'5555'5555'5555;
  bits = (bits | bits >> 1) & 0x3333'3333'3333'3333;
  bits = (bits | bits >> 2) & 0x0f0f'0f0f'0f0f'0f0f;
  bits = (bits | bits >> 4) & 0x00ff'00ff'00ff'00ff;
  bits = (bits | bits >> 8) & 0x0000'ffff'0000'ffff;
  return (bits | bits >> 16) & 0x0000'0000'ffff'ffff;
}

}  // namespace

void BlockedBits::Reserve(const OccupancyMap& map) {
  if (map.size() == size(Lattice::kCells)) return;
  number_ = 0;
  for (const Lattice lattice : {Lattice::kCells, Lattice::kBlocks}) {
    Layer& l = layer(lattice);
    const int side = lattice == Lattice::kCells ? 1 : kBlock;
    l.size = map.size() / side;
    l.words_per_row = (l.size.x() + kWord - 1) / kWord;
    const auto words = static_cast<std::size_t>(l.words_per_row) *
                       static_cast<std::size_t>(l.size.y()) * static_cast<std::size_t>(l.size.z());
    l.words.assign(words, 0);
    l.made.assign(words, 0);
  }
}

void BlockedBits::Begin(const FreeSpace& space, std::span<const Barrier> barriers) {
  Reserve(*space.map);
  space_ = space;
  barriers_ = barriers;
  if (++number_ != 0) return;
  for (Layer& l : layers_) std::fill(l.made.begin(), l.made.end(), 0);  // wrapped around
  number_ = 1;
}

std::uint64_t BlockedBits::Word(Lattice lattice, int row, int word) {
  Layer& l = layer(lattice);
  const auto i = static_cast<std::size_t>(row * l.words_per_row + word);
  if (l.made[i] != number_) {
    l.words[i] = lattice == Lattice::kCells ? OfCells(row, word) : OfBlocks(row, word);
    l.made[i] = number_;
  }
  return l.words[i];
}

bool BlockedBits::Blocked(Lattice lattice, const CellIndex& cell) {
  const int row = cell.z() * size(lattice).y() + cell.y();
  return (Word(lattice, row, cell.x() / kWord) >> (cell.x() % kWord) & 1u) != 0;
}

std::uint32_t BlockedBits::Around(Lattice lattice, const CellIndex& cell) {
  const Layer& l = layer(lattice);
  const int word = cell.x() / kWord, bit = cell.x() % kWord;
  std::uint32_t around = 0;
  for (int z = -1; z <= 1; ++z) {
    if (cell.z() + z < 0 || cell.z() + z >= l.size.z()) continue;
    for (int y = -1; y <= 1; ++y) {
      if (cell.y() + y < 0 || cell.y() + y >= l.size.y()) continue;
      const int row = (cell.z() + z) * l.size.y() + cell.y() + y;
      std::uint64_t three = Word(lattice, row, word);
      if (bit > 0) {
        three >>= bit - 1;
      } else {
        three <<= 1;
        if (word > 0) three |= Word(lattice, row, word - 1) >> (kWord - 1);
      }
      if (bit == kWord - 1 && word + 1 < l.words_per_row) {
        three |= (Word(lattice, row, word + 1) & 1u) << 2;
      }
      around |= static_cast<std::uint32_t>(three & 7u) << (9 * (z + 1) + 3 * (y + 1));
    }
  }
  return around;
}

std::uint64_t BlockedBits::OfBlocks(int row, int word) {
  const Layer& cells = layer(Lattice::kCells);
  const CellIndex& size = layer(Lattice::kBlocks).size;
  const int y = kBlock * (row % size.y()), z = kBlock * (row / size.y());
  std::uint64_t bits = 0;
  for (int half = 0; half < kBlock; ++half) {
    const int from = kBlock * word + half;
    if (from >= cells.words_per_row) break;
    std::uint64_t over = 0;
    for (int dz = 0; dz < kBlock; ++dz) {
      for (int dy = 0; dy < kBlock; ++dy) {
        over |= Word(Lattice::kCells, (z + dz) * cells.size.y() + y + dy, from);
      }
    }
    bits |= PairsToBits(over) << (half * kWord / kBlock);
  }
  return bits;
}

/// Of the cells of a row from `first` on, those over the pad: only within the strip's box need to be asked.
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

/// Of the cells of a row, those that belong to the barrier: only near its plane they need to be asked.
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

/// What FreeSpace::Blocked and the barriers say, with as much as possible said of whole rows.
std::uint64_t BlockedBits::OfCells(int row, int word) const {
  const OccupancyMap& map = *space_.map;
  const CellIndex& size = layer(Lattice::kCells).size;
  const CellIndex first = map.origin() + CellIndex(word * kWord, row % size.y(), row / size.y());
  const int count = std::min(kWord, size.x() - word * kWord);
  const std::uint64_t all = ~std::uint64_t{0} >> (kWord - count);
  const Eigen::Vector3d centre = map.CentreOf(first);
  const double half = 0.5 * map.resolution();
  const double low = centre.z() - half + FreeSpace::kLevelRounding;
  const bool too_low = low < space_.floor;
  const bool too_low_over_pad = space_.pad_radius > 0.0 ? low < space_.pad_floor : too_low;
  const bool too_high = centre.z() + half > space_.ceiling + FreeSpace::kLevelRounding;
  if (too_high || (too_low && too_low_over_pad)) return all;
  std::uint64_t bits = space_.ClosedRow(first, count);
  if (too_low != too_low_over_pad) {
    const std::uint64_t over = OverPad(first, count);
    bits |= too_low_over_pad ? over : all & ~over;
  }
  for (const Barrier& barrier : barriers_) bits |= Of(barrier, first, count);
  return bits;
}

}  // namespace touchdown::planning
