// SPDX-License-Identifier: BSD-3-Clause
// A* (P. Hart, N. Nilsson and B. Raphael 1968; eq. 16 of the paper) on the cells of the rolling
// map. What is known of a cell is indexed by its position in the window; the number of the search
// that it is from spares clearing it.

#include "touchdown/planning/grid_search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

/// A path of neighbouring cells cannot pass a plane without a cell this near to it.
constexpr double kHalfThickness = 0.9;  // [cells]
constexpr double kCosHalf = 0.1;  // a little less than half of the plane

bool InBarrier(const Eigen::Vector3d& centre, double resolution,
               std::span<const Barrier> barriers) {
  for (const Barrier& barrier : barriers) {
    const Eigen::Vector3d offset = centre - barrier.p;
    const double along = offset.dot(barrier.normal);
    if (std::abs(along) > kHalfThickness * resolution) continue;
    const Eigen::Vector3d across = offset - along * barrier.normal;
    if (across.dot(barrier.side) > kCosHalf * across.norm()) return true;
  }
  return false;
}

}  // namespace

GridSearch::GridSearch(double vertical_cost, double greed, double tight_cost)
    : vertical_cost_(static_cast<float>(vertical_cost)),
      greed_(static_cast<float>(greed)),
      tight_cost_(static_cast<float>(tight_cost)) {
  if (!(vertical_cost >= 1.0)) {
    throw std::invalid_argument("GridSearch: vertical_cost is " + std::to_string(vertical_cost) +
                                ", it must be >= 1");
  }
  if (!(greed >= 1.0)) {
    throw std::invalid_argument("GridSearch: greed is " + std::to_string(greed) +
                                ", it must be >= 1");
  }
  if (!(tight_cost >= 1.0)) {
    throw std::invalid_argument("GridSearch: tight_cost is " + std::to_string(tight_cost) +
                                ", it must be >= 1");
  }
  int n = 0;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        const auto flat2 = static_cast<float>(x * x + y * y);
        const float up = vertical_cost_ * static_cast<float>(z);
        steps_[n++] = {CellIndex(x, y, z), std::sqrt(flat2 + up * up)};
      }
    }
  }
}

/// Length of the shortest path between two cells of an empty lattice: the longest diagonals first.
float GridSearch::LatticeDistance(const CellIndex& a, const CellIndex& b) const {
  const CellIndex d = (a - b).cwiseAbs();
  const float w = vertical_cost_;
  const auto lo = static_cast<float>(std::min(d.x(), d.y()));
  const auto hi = static_cast<float>(std::max(d.x(), d.y()));
  const auto up = static_cast<float>(d.z());
  const float cubic = std::min(up, lo);                 // steps (1, 1, 1)
  const float slanted = std::min(up - cubic, hi - lo);  // steps (1, 0, 1)
  const float flat_diagonal = lo - cubic;               // steps (1, 1, 0)
  return cubic * std::sqrt(2.0f + w * w) + slanted * std::sqrt(1.0f + w * w) +
         flat_diagonal * std::sqrt(2.0f) + (hi - lo - slanted) + (up - cubic - slanted) * w;
}

bool GridSearch::NearestFree(const FreeSpace& space, CellIndex* cell) {
  if (!space.Blocked(*cell)) return true;
  const CellIndex centre = *cell;
  const double reach = kEndSearchRadius / space.map->resolution();
  double best = reach * reach;  // squared distance [cells]
  bool found = false;
  // Cube by cube outwards; a cell of the next one is at least its half side away.
  for (int n = 1; n <= reach && n * n < best; ++n) {
    CellIndex offset;
    for (offset.z() = -n; offset.z() <= n; ++offset.z()) {
      for (offset.y() = -n; offset.y() <= n; ++offset.y()) {
        const bool face = std::abs(offset.z()) == n || std::abs(offset.y()) == n;
        for (offset.x() = -n; offset.x() <= n; offset.x() += face ? 1 : 2 * n) {
          const double distance2 = offset.squaredNorm();
          const CellIndex candidate = centre + offset;
          if (distance2 >= best || !space.map->InWindow(candidate) || space.Blocked(candidate)) {
            continue;
          }
          best = distance2;
          *cell = candidate;
          found = true;
        }
      }
    }
  }
  return found;
}

void GridSearch::Reserve(const OccupancyMap& map) {
  const CellIndex& n = map.size();
  const auto cells = static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) *
                     static_cast<std::size_t>(n.z());
  if (cells_.size() == cells) return;
  cells_.assign(cells, Cell());
  search_ = 0;
}

void GridSearch::Begin(const OccupancyMap& map) {
  Reserve(map);
  if (++search_ > kMostSearches) {
    std::fill(cells_.begin(), cells_.end(), Cell());
    search_ = 1;
  }
  heap_.clear();
  expansions_ = 0;
}

SearchStatus GridSearch::Search(const FreeSpace& space, const Eigen::Vector3d& from,
                                const Eigen::Vector3d& to, int max_expansions, GuidePath* path,
                                std::span<const Barrier> barriers) {
  path->clear();
  const OccupancyMap& map = *space.map;
  CellIndex start = map.CellOf(from), goal = map.CellOf(to);
  if (!map.InWindow(start) || !map.InWindow(goal)) return SearchStatus::kEndsOutside;
  if (!NearestFree(space, &start) || !NearestFree(space, &goal)) return SearchStatus::kEndsBlocked;
  Begin(map);

  const CellIndex origin = map.origin(), size = map.size();
  const auto address = [&](const CellIndex& cell) {
    const CellIndex i = cell - origin;
    return static_cast<std::uint32_t>((i.z() * size.y() + i.y()) * size.x() + i.x());
  };
  const auto cell_at = [&](std::uint32_t a) {
    const int i = static_cast<int>(a);
    return CellIndex(origin +
                     CellIndex(i % size.x(), i / size.x() % size.y(), i / (size.x() * size.y())));
  };
  const auto later = [](const Node& a, const Node& b) {
    return a.f != b.f ? a.f > b.f : a.order > b.order;
  };
  const auto estimate = [&](const CellIndex& cell) { return greed_ * LatticeDistance(cell, goal); };
  const auto closed_to = [&](const CellIndex& cell) {
    return space.Blocked(cell) ||
           (!barriers.empty() && InBarrier(map.CentreOf(cell), map.resolution(), barriers));
  };
  std::uint32_t order = 0;
  const std::uint32_t goal_address = address(goal);
  const std::uint32_t start_address = address(start);
  cells_[start_address] = Cell(0.0f, search_, kNoParent, false);
  heap_.push_back({estimate(start), order++, start_address});

  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const std::uint32_t here = heap_.back().address;
    heap_.pop_back();
    if (cells_[here].closed) continue;  // an older, longer entry of the same cell
    cells_[here].closed = true;
    if (here == goal_address) {
      for (CellIndex cell = goal;;) {
        path->push_back(map.CentreOf(cell));
        const unsigned by = cells_[address(cell)].parent;
        if (by == kNoParent) break;
        cell -= steps_[by].offset;
      }
      std::reverse(path->begin(), path->end());
      return SearchStatus::kFound;
    }
    if (++expansions_ > max_expansions) return SearchStatus::kExpansionLimit;
    const CellIndex cell = cell_at(here);
    float factor = 1.0f;
    for (const Step& step : steps_) {
      const CellIndex next = cell + step.offset;
      if (!map.InWindow(next)) continue;
      Cell& there = cells_[address(next)];
      if (there.search != search_ && closed_to(next)) there = Cell(0.0f, search_, kBlocked, true);
      if (there.search == search_ && there.parent == kBlocked) factor = tight_cost_;
    }
    const float g_here = cells_[here].g;
    for (unsigned s = 0; s < steps_.size(); ++s) {
      const CellIndex next = cell + steps_[s].offset;
      if (!map.InWindow(next)) continue;
      Cell& there = cells_[address(next)];
      const float g = g_here + factor * steps_[s].length;
      if (there.search == search_ && (there.closed || g >= there.g)) continue;
      there = Cell(g, search_, s, false);
      heap_.push_back({g + estimate(next), order++, address(next)});
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
  }
  return SearchStatus::kNoPath;
}

}  // namespace touchdown::planning
