// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "touchdown/planning/map/cell_box.h"

namespace touchdown::planning {

struct HullSpace;

/// Around a start, the cells in which the hull would touch cells that are not observed free. For
/// the next stops they are as closed as an obstacle. A plan whose pair met such a cell is made
/// again around them.
class UnseenZone {
 public:
  static constexpr double kFarthest = 1.2;  ///< reach at most [m]

  /// Considers the cells within `reach` [m] of `start_W`. Cells that the hull touches at the start
  /// already do not close, nor what SweepHull excepts. Does not allocate.
  void Build(const HullSpace& hull, const Eigen::Vector3d& start_W, double reach);

  bool Holds(const CellIndex& cell) const { return Row(cell, 1) != 0; }

  /// Bit i: the cell i beyond `first` along x is closed; `count` at most 64.
  std::uint64_t Row(const CellIndex& first, int count) const;

 private:
  // Room for kFarthest and a hull of 0.7 m in cells of 0.1 m, in rows of one word.
  static constexpr int kReach = 31;
  static constexpr int kSide = 2 * kReach + 1;
  using Rows = std::array<std::uint64_t, static_cast<std::size_t>(kSide* kSide)>;

  static std::size_t RowOf(int y, int z) { return static_cast<std::size_t>(z * kSide + y); }

  CellIndex low_ = CellIndex::Zero();  // of bit 0 of row (0, 0)
  Rows missing_{}, closed_{};
  Rows spread_{};  // of missing_, while they are laid over each other
};

}  // namespace touchdown::planning
