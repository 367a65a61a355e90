// SPDX-License-Identifier: BSD-3-Clause
// Cells that are not observed free, grown by the hull. Rows of 63 cells are in a word. They are
// grown along x step by step, once for each width of the ball, and combined over the rows that the
// ball reaches.

#include "touchdown/planning/certify/unseen_zone.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "touchdown/planning/certify/swept_hull.h"

namespace touchdown::planning {

void UnseenZone::Build(const HullSpace& hull, const Eigen::Vector3d& start_W, double reach) {
  const OccupancyMap& map = *hull.space->map;
  const double side = map.resolution();
  const CellIndex centre = map.CellOf(start_W);
  low_ = centre.array() - kReach;
  missing_.fill(0);
  closed_.fill(0);
  // Between a cell's centre and the nearest point of one that it may not touch.
  const double radius = hull.radius() / side + 0.5;
  const int around = std::min(kSide, static_cast<int>(std::ceil(radius)));
  const double farthest = std::min(reach, kFarthest);
  const int asked = std::min(kReach, static_cast<int>(farthest / side) + around + 1);
  const double ground = map.options().ground_height;
  const double deck = hull.pad != nullptr ? hull.pad->MeanAt(0.0).p_WP.z() + side : ground;
  // Only cells of this box may be touched at the start.
  const int beside = around + 1;
  const std::uint64_t beside_x = (~std::uint64_t{0} >> (64 - std::min(64, 2 * beside + 1)))
                                 << std::max(0, asked - beside);
  for (int z = kReach - asked; z <= kReach + asked; ++z) {
    for (int y = kReach - asked; y <= kReach + asked; ++y) {
      const CellIndex first = low_ + CellIndex(kReach - asked, y, z);
      const int count = 2 * asked + 1;
      if ((first.z() + 1) * side <= ground + 1e-9) continue;
      const bool in_window =
          map.InWindow(first) && map.InWindow(first + CellIndex(count - 1, 0, 0));
      std::uint64_t bits = ~std::uint64_t{0} >> (64 - count);
      if (in_window) bits &= ~map.ObservedFreeRow(first, count);
      const bool may_be_deck = (first.z() + 1) * side <= deck + 1e-9;
      std::uint64_t asks = may_be_deck ? bits : 0;
      if (std::max(std::abs(y - kReach), std::abs(z - kReach)) <= beside) asks |= bits & beside_x;
      for (std::uint64_t left = asks; left != 0; left &= left - 1) {
        const int x = std::countr_zero(left);
        const Eigen::Vector3d p = map.CentreOf(first + CellIndex(x, 0, 0));
        const Eigen::Array3d off = ((p - start_W).array().abs() - 0.5 * side).max(0.0);
        const bool touched = off.matrix().norm() < hull.radius();
        const bool over = may_be_deck && hull.space->OverPad(p);
        if (touched || over) bits &= ~(std::uint64_t{1} << x);
      }
      missing_[RowOf(y, z)] = bits << (kReach - asked);
    }
  }
  const int kept = std::min(kReach, static_cast<int>(farthest / side));
  const int first = kReach - kept, rows = 2 * kept + 1;
  spread_ = missing_;
  for (int width = 0; width <= around; ++width) {
    if (width > 0) {
      for (std::uint64_t& bits : spread_) bits |= bits << 1 | bits >> 1;
    }
    // Over the rows of the ball that are so wide.
    for (int dz = -around; dz <= around; ++dz) {
      for (int dy = -around; dy <= around; ++dy) {
        const double left = radius * radius - dz * dz - dy * dy;
        if (left < 0.0 || static_cast<int>(std::sqrt(left)) != width) continue;
        const int from = std::max(0, first + dy), to = std::min(kSide, first + rows + dy);
        if (from >= to) continue;
        for (int z = std::max(0, first + dz); z < std::min(kSide, first + rows + dz); ++z) {
          std::uint64_t* const closed = &closed_[RowOf(from - dy, z - dz)];
          const std::uint64_t* const touching = &spread_[RowOf(from, z)];
          for (int i = 0; i < to - from; ++i) closed[i] |= touching[i];
        }
      }
    }
  }
  const std::uint64_t columns = (~std::uint64_t{0} >> (64 - rows)) << first;
  for (std::uint64_t& bits : closed_) bits &= columns;
  // Where the hull is already it may be, whatever the rounding of the lattice.
  closed_[RowOf(kReach, kReach)] &= ~(std::uint64_t{1} << kReach);
}

std::uint64_t UnseenZone::Row(const CellIndex& first, int count) const {
  const CellIndex at = first - low_;
  if (at.y() < 0 || at.y() >= kSide || at.z() < 0 || at.z() >= kSide) return 0;
  if (at.x() >= kSide || at.x() + count <= 0) return 0;
  const std::uint64_t row = closed_[RowOf(at.y(), at.z())];
  const std::uint64_t bits = at.x() >= 0 ? row >> at.x() : row << -at.x();
  return bits & ~std::uint64_t{0} >> (64 - count);
}

}  // namespace touchdown::planning
