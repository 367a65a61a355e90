// SPDX-License-Identifier: BSD-3-Clause
// A* (P. Hart, N. Nilsson, B. Raphael 1968) with the baseline's lattice and heuristic.

#include "planning/baselines/ego/ego_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchdown::planning {

namespace {

constexpr double kTieBreaker = 1.0001;  // the heuristic's factor
constexpr std::uint8_t kNoParent = 26;

/// Length of the shortest way on an empty lattice of 26 neighbours, in cells.
double DiagonalDistance(const Eigen::Vector3i& from, const Eigen::Vector3i& to) {
  std::array<int, 3> d = {std::abs(from.x() - to.x()), std::abs(from.y() - to.y()),
                          std::abs(from.z() - to.z())};
  std::sort(d.begin(), d.end());
  return std::sqrt(3.0) * d[0] + std::sqrt(2.0) * (d[1] - d[0]) + (d[2] - d[1]);
}

}  // namespace

EgoSearch::EgoSearch(const EgoOptions& options)
    : step_(options.search_step),
      cells_(options.search_cells),
      max_expansions_(options.search_expansions) {
  int k = 0;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        steps_[k++] = {{x, y, z}, std::sqrt(static_cast<double>(x * x + y * y + z * z))};
      }
    }
  }
  const auto nodes = static_cast<std::size_t>(cells_) * cells_ * cells_;
  g_.resize(nodes);
  parent_.resize(nodes);
  seen_.assign(nodes, 0);
}

Eigen::Vector3i EgoSearch::IndexOf(const Eigen::Vector3d& p_W) const {
  const Eigen::Array3d cell = ((p_W - centre_) / step_).array().round();
  return cell.max(-1e6).min(1e6).matrix().cast<int>() + Eigen::Vector3i::Constant(cells_ / 2);
}

Eigen::Vector3d EgoSearch::PointOf(const Eigen::Vector3i& index) const {
  return centre_ + step_ * (index - Eigen::Vector3i::Constant(cells_ / 2)).cast<double>();
}

bool EgoSearch::Contains(const Eigen::Vector3i& index) const {
  return (index.array() >= 0).all() && (index.array() < cells_).all();
}

std::uint32_t EgoSearch::Address(const Eigen::Vector3i& index) const {
  return static_cast<std::uint32_t>((index.z() * cells_ + index.y()) * cells_ + index.x());
}

Eigen::Vector3i EgoSearch::IndexAt(std::uint32_t address) const {
  const int a = static_cast<int>(address);
  return {a % cells_, a / cells_ % cells_, a / (cells_ * cells_)};
}

/// Steps along `away` until p_W's lattice point is free; false once that is off the lattice.
bool EgoSearch::MoveOut(const EgoGrid& grid, const Eigen::Vector3d& away,
                        Eigen::Vector3d* p_W) const {
  while (Contains(IndexOf(*p_W))) {
    if (!grid.Occupied(PointOf(IndexOf(*p_W)))) return true;
    if (away.isZero()) return false;
    *p_W += step_ * away;
  }
  return false;
}

void EgoSearch::Push(std::uint32_t address, double f) {
  heap_.push_back({f, pushed_++, address});
  std::push_heap(heap_.begin(), heap_.end(), [](const Node& a, const Node& b) {
    return a.f != b.f ? a.f > b.f : a.order > b.order;
  });
}

EgoSearchStatus EgoSearch::Search(const EgoGrid& grid, const Eigen::Vector3d& from,
                                  const Eigen::Vector3d& to, std::vector<Eigen::Vector3d>* path) {
  path->clear();
  centre_ = 0.5 * (from + to);
  const Eigen::Vector3d along = (to - from).normalized();
  Eigen::Vector3d start_point = from, goal_point = to;
  if (!MoveOut(grid, -along, &start_point) || !MoveOut(grid, along, &goal_point)) {
    return EgoSearchStatus::kEndsTooFar;
  }
  const Eigen::Vector3i start = IndexOf(start_point), goal = IndexOf(goal_point);

  if (search_ >= std::numeric_limits<std::uint32_t>::max() / 2 - 1) {
    std::fill(seen_.begin(), seen_.end(), 0);
    search_ = 0;
  }
  ++search_;
  const std::uint32_t open = 2 * search_, closed = open + 1;
  heap_.clear();
  pushed_ = 0;
  g_[Address(start)] = 0.0;
  parent_[Address(start)] = kNoParent;
  seen_[Address(start)] = open;
  Push(Address(start), kTieBreaker * DiagonalDistance(start, goal));
  for (int expansions = 0; !heap_.empty();) {
    std::pop_heap(heap_.begin(), heap_.end(), [](const Node& a, const Node& b) {
      return a.f != b.f ? a.f > b.f : a.order > b.order;
    });
    const std::uint32_t address = heap_.back().address;
    heap_.pop_back();
    if (seen_[address] == closed) continue;
    seen_[address] = closed;
    Eigen::Vector3i index = IndexAt(address);
    if (index == goal) {
      for (;;) {
        path->push_back(PointOf(index));
        const std::uint8_t parent = parent_[Address(index)];
        if (parent == kNoParent) break;
        index -= steps_[parent].offset;
      }
      std::reverse(path->begin(), path->end());
      return EgoSearchStatus::kFound;
    }
    if (++expansions > max_expansions_) return EgoSearchStatus::kExpansionLimit;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Eigen::Vector3i next = index + steps_[k].offset;
      if (!Contains(next)) continue;
      const std::uint32_t to_address = Address(next);
      const double g = g_[address] + steps_[k].length;
      if (seen_[to_address] == closed || (seen_[to_address] == open && g >= g_[to_address])) {
        continue;
      }
      if (grid.Occupied(PointOf(next))) continue;
      g_[to_address] = g;
      parent_[to_address] = static_cast<std::uint8_t>(k);
      seen_[to_address] = open;
      Push(to_address, g + kTieBreaker * DiagonalDistance(next, goal));
    }
  }
  return EgoSearchStatus::kNoPath;
}

}  // namespace touchdown::planning
