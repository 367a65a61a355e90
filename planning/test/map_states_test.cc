// SPDX-License-Identifier: BSD-3-Clause
// A map that is rebuilt from its cells' states answers a planner as the first one did.
#include <gtest/gtest.h>

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {
namespace {

TEST(MapStates, RebuildAMap) {
  OccupancyMapOptions options;
  options.size_log2 = {6, 6, 4};
  options.inflation_radius = 0.3;
  OccupancyMap map(options), copy(options);
  map.Recentre({3.7, -2.3, 0.4});
  map.MarkFree({3.7, -2.3, 0.4}, 0.8);
  map.SetOccupied({4.6, -2.3, 0.4});
  std::vector<CellState> states, again;
  map.CopyStates(&states);
  copy.MoveWindow(map.origin());
  EXPECT_EQ(copy.origin(), map.origin());
  const auto for_each_cell = [&](const auto& visit) {
    CellIndex c;
    const CellIndex lo = map.origin(), hi = map.origin() + map.size();
    for (c.z() = lo.z(); c.z() < hi.z(); ++c.z()) {
      for (c.y() = lo.y(); c.y() < hi.y(); ++c.y()) {
        for (c.x() = lo.x(); c.x() < hi.x(); ++c.x()) visit(c);
      }
    }
  };
  auto state = states.begin();
  for_each_cell([&](const CellIndex& cell) {
    EXPECT_EQ(map.IsOccupied(cell), *state == CellState::kOccupied);
    EXPECT_EQ(map.IsObservedFree(cell), *state == CellState::kFree);
    copy.SetState(cell, *state++);
  });
  for_each_cell([&](const CellIndex& cell) {
    EXPECT_EQ(map.IsBlocked(cell), copy.IsBlocked(cell));
    EXPECT_EQ(map.IsOccupied(cell), copy.IsOccupied(cell));
  });
  copy.CopyStates(&again);
  EXPECT_EQ(states, again);
  copy.SetState(copy.CellOf({4.6, -2.3, 0.4}), CellState::kUnknown);
  EXPECT_FALSE(copy.IsBlocked(Eigen::Vector3d(4.6, -2.1, 0.4)));
}

}  // namespace
}  // namespace touchdown::planning
