// SPDX-License-Identifier: BSD-3-Clause
// A* (P. Hart, N. Nilsson and B. Raphael 1968; eq. 16 of the paper) on the cells of the rolling
// map. The data of a cell are indexed by its position in the window. They carry the number of their
// search, so that they need not be cleared.

#include "planning/search/grid_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <boost/heap/d_ary_heap.hpp>

namespace touchdown::planning {

namespace {

/// Bits of the steps that lead to one side: the offset along `axis` is `side`.
constexpr std::uint32_t StepsTo(int axis, int side) {
  std::uint32_t bits = 0;
  constexpr int kStride[] = {1, 3, 9};
  for (int s = 0; s < 27; ++s) {
    if (s / kStride[axis] % 3 - 1 == side) bits |= 1u << s;
  }
  return bits;
}

// Room at first; a search that needs more makes more.
constexpr std::size_t kUsualQueue = 1 << 16;
constexpr std::size_t kPathReserve = 1024;

constexpr std::uint32_t kAllSteps = (1u << 27) - 1;
constexpr std::uint32_t kBelow[] = {StepsTo(0, -1), StepsTo(1, -1), StepsTo(2, -1)};
constexpr std::uint32_t kAbove[] = {StepsTo(0, 1), StepsTo(1, 1), StepsTo(2, 1)};

}  // namespace

// Addresses, the least f first, and of these the one that came first.
class GridSearch::Queue {
 public:
  void Reserve(std::size_t size) { nodes_.reserve(size); }
  void Clear() {
    nodes_.clear();
    order_ = 0;
  }
  bool empty() const { return nodes_.empty(); }
  void Push(float f, std::uint32_t address) {
    // The bits of positive floats are ordered as they are.
    std::uint32_t bits;
    static_assert(sizeof(bits) == sizeof(f));
    std::memcpy(&bits, &f, sizeof(bits));  // std::bit_cast is not in every library yet
    nodes_.push({static_cast<std::uint64_t>(bits) << 32 | order_++, address});
  }
  std::uint32_t Pop() {
    const std::uint32_t address = nodes_.top().address;
    nodes_.pop();
    return address;
  }

 private:
  struct Node {
    std::uint64_t key;  // f, then the order of insertion
    std::uint32_t address;
    bool operator>(const Node& other) const { return key > other.key; }
  };
  // Four children per node: half the levels of a binary heap, and the children are adjacent.
  boost::heap::d_ary_heap<Node, boost::heap::arity<4>, boost::heap::compare<std::greater<Node>>>
      nodes_;
  std::uint32_t order_ = 0;
};

double PathLength(const GuidePath& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

GridSearch::GridSearch(double vertical_cost, double greed, double tight_cost)
    : vertical_cost_(static_cast<float>(vertical_cost)),
      slanted_(std::sqrt(1.0f + vertical_cost_ * vertical_cost_)),
      cubic_(std::sqrt(2.0f + vertical_cost_ * vertical_cost_)),
      greed_(static_cast<float>(greed)),
      tight_cost_(static_cast<float>(tight_cost)),
      queue_(std::make_unique<Queue>()) {
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
        const auto flat2 = static_cast<float>(x * x + y * y);
        const float up = vertical_cost_ * static_cast<float>(z);
        steps_[n++] = {CellIndex(x, y, z), std::sqrt(flat2 + up * up), 0};
      }
    }
  }
}

GridSearch::~GridSearch() = default;
GridSearch::GridSearch(GridSearch&&) noexcept = default;
GridSearch& GridSearch::operator=(GridSearch&&) noexcept = default;

/// Length of the shortest path between two cells of an empty lattice: the longest diagonals first.
float GridSearch::LatticeDistance(const CellIndex& a, const CellIndex& b) const {
  const CellIndex d = (a - b).cwiseAbs();
  const auto lo = static_cast<float>(std::min(d.x(), d.y()));
  const auto hi = static_cast<float>(std::max(d.x(), d.y()));
  const auto up = static_cast<float>(d.z());
  const float cubic = std::min(up, lo);                 // steps (1, 1, 1)
  const float slanted = std::min(up - cubic, hi - lo);  // steps (1, 0, 1)
  const float flat_diagonal = lo - cubic;               // steps (1, 1, 0)
  return cubic * cubic_ + slanted * slanted_ + flat_diagonal * std::numbers::sqrt2_v<float> +
         (hi - lo - slanted) + (up - cubic - slanted) * vertical_cost_;
}

/// Of equally distant cells the one in the smallest cube around the centre, then the lowest along
/// z, y and x.
bool GridSearch::NearestFree(const FreeSpace& space, CellIndex* cell) {
  if (!space.Blocked(*cell)) return true;
  const OccupancyMap& map = *space.map;
  const CellIndex centre = *cell;
  const int reach = static_cast<int>(kEndSearchRadius / map.resolution());
  const int last_x = map.origin().x() + map.size().x() - 1;
  // Squared distance [cells], half side of the cube, and the place in it.
  using Rank = std::array<int, 5>;
  const double farthest = kEndSearchRadius / map.resolution();
  Rank best = {static_cast<int>(std::ceil(farthest * farthest)), 0, 0, 0, 0};
  bool found = false;
  const auto look = [&](int y, int z) {
    const int to_row2 = y * y + z * z;
    const CellIndex middle = centre + CellIndex(0, y, z);
    for (int from = -reach; from <= reach; from += 64) {
      CellIndex first = middle + CellIndex(from, 0, 0);
      first.x() = std::max(first.x(), map.origin().x());
      const int count = std::min({64, centre.x() + reach - first.x() + 1, last_x - first.x() + 1});
      if (count <= 0 || !map.InWindow(first)) continue;
      std::uint64_t open = ~space.ClosedRow(first, count) & (~std::uint64_t{0} >> (64 - count));
      for (; open != 0; open &= open - 1) {
        const int x = first.x() + std::countr_zero(open) - centre.x();
        const int side = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const Rank rank = {to_row2 + x * x, side, z, y, x};
        const CellIndex candidate = middle + CellIndex(x, 0, 0);
        if (rank >= best || space.Blocked(candidate)) continue;
        best = rank;
        *cell = candidate;
        found = true;
      }
    }
  };
  // Ring by ring of rows outwards.
  for (int n = 0; n <= reach && n * n <= best[0]; ++n) {
    for (int z = -n; z <= n; ++z) {
      for (int y = -n; y <= n; y += std::abs(z) == n ? 1 : 2 * n) look(y, z);
    }
  }
  return found;
}

void GridSearch::Reserve(const OccupancyMap& map) {
  blocked_.Reserve(map);
  queue_->Reserve(kUsualQueue);
  way_.reserve(kPathReserve);
  const auto cells = static_cast<std::size_t>(map.size().cast<std::int64_t>().prod());
  if (cells_.size() == cells) return;
  cells_.assign(cells, Cell());
  search_ = 0;
}

/// The steps that leave the window.
std::uint32_t GridSearch::Outside(const CellIndex& cell) const {
  const CellIndex& size = blocked_.size();
  std::uint32_t outside = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] == 0) outside |= kBelow[axis];
    if (cell[axis] == size[axis] - 1) outside |= kAbove[axis];
  }
  return outside;
}

void GridSearch::Begin() {
  const CellIndex& size = blocked_.size();
  for (Step& step : steps_) {
    step.address = (step.offset.z() * size.y() + step.offset.y()) * size.x() + step.offset.x();
  }
  if (++search_ > kMostSearches) {
    std::fill(cells_.begin(), cells_.end(), Cell());
    search_ = 1;
  }
  queue_->Clear();
  way_.clear();
}

SearchStatus GridSearch::Search(const FreeSpace& space, const Eigen::Vector3d& from,
                                const Eigen::Vector3d& to, int max_expansions, GuidePath* path,
                                std::span<const Barrier> barriers) {
  path->clear();
  expansions_ = 0;
  const OccupancyMap& map = *space.map;
  CellIndex start = map.CellOf(from), goal = map.CellOf(to);
  if (!map.InWindow(start) || !map.InWindow(goal)) return SearchStatus::kEndsOutside;
  if (!NearestFree(space, &start) || !NearestFree(space, &goal)) return SearchStatus::kEndsBlocked;
  Reserve(map);
  blocked_.Begin(space, barriers);

  // From here on cells are counted from the window's lowest one.
  start -= map.origin();
  goal -= map.origin();
  const SearchStatus status = SearchOn(start, goal, max_expansions);
  for (const CellIndex& cell : way_) path->push_back(map.CentreOf(cell + map.origin()));
  return status;
}

SearchStatus GridSearch::SearchOn(const CellIndex& start, const CellIndex& goal,
                                  int max_expansions) {
  Begin();
  const CellIndex& size = blocked_.size();
  const auto address = [&](const CellIndex& cell) {
    return static_cast<std::uint32_t>((cell.z() * size.y() + cell.y()) * size.x() + cell.x());
  };
  const auto cell_at = [&](std::uint32_t a) {
    const int i = static_cast<int>(a);
    return CellIndex(i % size.x(), i / size.x() % size.y(), i / (size.x() * size.y()));
  };
  const auto estimate = [&](const CellIndex& cell) { return greed_ * LatticeDistance(cell, goal); };
  const std::uint32_t goal_address = address(goal);
  const std::uint32_t start_address = address(start);
  cells_[start_address] = Cell(0.0f, search_, kSelf, false);
  queue_->Push(estimate(start), start_address);

  while (!queue_->empty()) {
    const std::uint32_t here = queue_->Pop();
    if (cells_[here].closed) continue;  // an older, longer entry of the same cell
    cells_[here].closed = true;
    if (here == goal_address) {
      for (CellIndex cell = goal;;) {
        way_.push_back(cell);
        const unsigned by = cells_[address(cell)].parent;
        if (by == kSelf) break;
        cell -= steps_[by].offset;
      }
      std::reverse(way_.begin(), way_.end());
      return SearchStatus::kFound;
    }
    if (expansions_ >= max_expansions) return SearchStatus::kExpansionLimit;
    ++expansions_;
    const CellIndex cell = cell_at(here);
    const std::uint32_t blocked = blocked_.Around(cell) & ~(1u << kSelf);
    const float factor = blocked != 0 ? tight_cost_ : 1.0f;
    const float g_here = cells_[here].g;
    std::uint32_t open = ~(blocked | Outside(cell) | 1u << kSelf) & kAllSteps;
    for (; open != 0; open &= open - 1) {
      const auto s = static_cast<unsigned>(std::countr_zero(open));
      const Step& step = steps_[s];
      const std::uint32_t next = here + static_cast<std::uint32_t>(step.address);
      Cell& there = cells_[next];
      const float g = g_here + factor * step.length;
      if (there.search == search_ && (there.closed || g >= there.g)) continue;
      there = Cell(g, search_, s, false);
      queue_->Push(g + estimate(cell + step.offset), next);
    }
  }
  return SearchStatus::kNoPath;
}

}  // namespace touchdown::planning
