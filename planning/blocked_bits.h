// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "touchdown/planning/barrier.h"
#include "touchdown/planning/free_space.h"

namespace touchdown::planning {

/// Cells to a side of a block.
inline constexpr int kBlock = 2;

/// The lattices that a window is looked at on.
enum class Lattice {
  kCells,
  kBlocks,  ///< kBlock cells to a side, from the window's lowest cell on; blocked if one of them is
};

/// The blocked cells of a window, or the blocked blocks of cells, as bits, 64 along x to a word. A word is
/// made when it is first asked for: a search asks for the same cell from up to 26 sides, and only where it
/// comes.
class BlockedBits {
 public:
  /// Makes room for this map's window, which Begin does otherwise.
  void Reserve(const OccupancyMap& map);

  /// From now on of this space and these barriers, which must outlive the calls of Around. Allocates only
  /// to grow to a high-water mark.
  void Begin(const FreeSpace& space, std::span<const Barrier> barriers);

  /// Cells of the window on a lattice.
  const CellIndex& size(Lattice lattice) const { return layer(lattice).size; }

  /// The 3 x 3 x 3 cells around a cell of the lattice, counted from the window's lowest one: bit
  /// 9 (z + 1) + 3 (y + 1) + x + 1 for the cell at the offset (x, y, z). Out of the window: not set.
  std::uint32_t Around(Lattice lattice, const CellIndex& cell);

  /// One cell of the lattice, which must be in the window.
  bool Blocked(Lattice lattice, const CellIndex& cell);

 private:
  struct Layer {
    CellIndex size = CellIndex::Zero();
    int words_per_row = 0;
    std::vector<std::uint64_t> words;
    std::vector<std::uint32_t> made;  // with which number; 0: never
  };

  const Layer& layer(Lattice lattice) const { return layers_[static_cast<std::size_t>(lattice)]; }
  Layer& layer(Lattice lattice) { return layers_[static_cast<std::size_t>(lattice)]; }
  std::uint64_t Word(Lattice lattice, int row, int word);
  std::uint64_t OfCells(int row, int word) const;
  std::uint64_t OverPad(const CellIndex& first, int count) const;
  std::uint64_t Of(const Barrier& barrier, const CellIndex& first, int count) const;
  std::uint64_t OfBlocks(int row, int word);

  FreeSpace space_;
  std::span<const Barrier> barriers_;
  std::array<Layer, 2> layers_;
  std::uint32_t number_ = 0;
};

}  // namespace touchdown::planning
