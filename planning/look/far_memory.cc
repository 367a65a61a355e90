// SPDX-License-Identifier: BSD-3-Clause
#include "planning/look/far_memory.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {
namespace {

constexpr int kMoves = 16;  // cells at a time

OccupancyMapOptions FarOptions(const OccupancyMapOptions& options) {
  OccupancyMapOptions far = options;
  far.resolution *= FarMemory::kApart;
  far.thinnest_obstacle = far.resolution;
  far.inflation_radius = 0.0;  // what blocks is kept, not what stands there
  far.size_log2 = {9, 9, 5};
  return far;
}

}  // namespace

FarMemory::FarMemory(const OccupancyMap& map, double floor) : far_(FarOptions(map.options())) {
  far_.MoveWindow({0, 0, static_cast<int>(std::floor(floor / far_.resolution()))});
}

void FarMemory::Keep(const OccupancyMap& map) {
  CellIndex origin = (map.origin() + map.size() / 2) / kApart - far_.size() / 2;
  origin.z() = far_.origin().z();
  if ((origin - far_.origin()).cwiseAbs().maxCoeff() >= kMoves) far_.MoveWindow(origin);
  constexpr int kMiddle = kApart / 2, kInWord = 64 / kApart;
  const auto first_of = [](int cell) {  // whose middle is there or beyond
    return (cell - kMiddle + (cell > kMiddle ? kApart - 1 : 0)) / kApart;
  };
  const CellIndex low = map.origin().unaryExpr(first_of);
  const CellIndex high = (map.origin() + map.size()).unaryExpr(first_of);
  for (int z = low.z(); z < high.z(); ++z) {
    for (int y = low.y(); y < high.y(); ++y) {
      for (int x = low.x(); x < high.x(); x += kInWord) {
        const int count = std::min(kInWord, high.x() - x);
        const CellIndex first(x, y, z), middle = kApart * first + CellIndex::Constant(kMiddle);
        const int cells = kApart * (count - 1) + 1;
        const std::uint64_t blocked = map.BlockedRow(middle, cells);
        const std::uint64_t known = far_.OccupiedRow(first, count);
        if (blocked == 0 && known == 0) continue;
        const std::uint64_t free = map.ObservedFreeRow(middle, cells) & ~blocked;
        for (int i = 0; i < count; ++i) {
          const bool was = known >> i & 1;
          const bool is = (blocked >> kApart * i & 1) || (was && !(free >> kApart * i & 1));
          const CellIndex cell = first + i * CellIndex::UnitX();
          if (is != was) far_.SetState(cell, is ? CellState::kOccupied : CellState::kUnknown);
        }
      }
    }
  }
}

}  // namespace touchdown::planning
