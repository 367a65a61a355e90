// SPDX-License-Identifier: BSD-3-Clause
#include "planning/look/far_memory.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {
namespace {

constexpr double kApart = 0.3;  // [m]
constexpr int kMoves = 16;      // cells at a time

OccupancyMapOptions FarOptions(const OccupancyMapOptions& options, int apart) {
  OccupancyMapOptions far = options;
  far.resolution *= apart;
  far.thinnest_obstacle = far.resolution;
  far.inflation_radius = 0.0;  // what blocks is kept, not what stands there
  far.size_log2 = {9, 9, 5};
  return far;
}

}  // namespace

FarMemory::FarMemory(const OccupancyMap& map, double floor)
    : apart_(std::max(1, static_cast<int>(std::lround(kApart / map.resolution())))),
      far_(FarOptions(map.options(), apart_)) {
  // One level below the floor: that is no way out.
  far_.MoveWindow({0, 0, static_cast<int>(std::floor(floor / far_.resolution())) - 1});
}

void FarMemory::Keep(const OccupancyMap& map) {
  CellIndex origin = (map.origin() + map.size() / 2) / apart_ - far_.size() / 2;
  origin.z() = far_.origin().z();
  if ((origin - far_.origin()).cwiseAbs().maxCoeff() >= kMoves) far_.MoveWindow(origin);
  const int half = apart_ / 2, in_word = std::max(1, 64 / apart_);
  const auto first_of = [&](int cell) {  // whose middle is there or beyond
    return (cell - half + (cell > half ? apart_ - 1 : 0)) / apart_;
  };
  const CellIndex low = map.origin().unaryExpr(first_of);
  const CellIndex high = (map.origin() + map.size()).unaryExpr(first_of);
  for (int z = low.z(); z < high.z(); ++z) {
    for (int y = low.y(); y < high.y(); ++y) {
      for (int x = low.x(); x < high.x(); x += in_word) {
        const int count = std::min(in_word, high.x() - x);
        const CellIndex first(x, y, z), middle = apart_ * first + CellIndex::Constant(half);
        const int cells = apart_ * (count - 1) + 1;
        const std::uint64_t blocked = map.BlockedRow(middle, cells);
        const std::uint64_t known = far_.OccupiedRow(first, count);
        if (blocked == 0 && known == 0) continue;
        const std::uint64_t free = map.ObservedFreeRow(middle, cells) & ~blocked;
        for (int i = 0; i < count; ++i) {
          const bool was = known >> i & 1;
          const bool is = (blocked >> apart_ * i & 1) || (was && !(free >> apart_ * i & 1));
          const CellIndex cell = first + i * CellIndex::UnitX();
          if (is != was) far_.SetState(cell, is ? CellState::kOccupied : CellState::kUnknown);
        }
      }
    }
  }
}

}  // namespace touchdown::planning
