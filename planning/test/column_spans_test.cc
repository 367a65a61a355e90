// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/column_spans.h"

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

// Span by span against the cells, also where a window is narrower than a word and where it wraps around.
TEST(ColumnSpans, SayWhatTheCellsOfAColumnSay) {
  Draw draw(31);
  ColumnSpans columns;
  int several = 0;
  for (int trial = 0; trial < 6; ++trial) {
    OccupancyMapOptions options = SmallMap(0.1);
    options.size_log2 = trial % 2 == 0 ? Eigen::Vector3i(7, 5, 4) : Eigen::Vector3i(4, 5, 5);
    OccupancyMap map(options);
    map.Recentre({draw.Uniform(-20, 20), draw.Uniform(-20, 20), draw.Uniform(-1, 1)});
    const Eigen::Vector3d low = map.CentreOf(map.origin());
    const Eigen::Vector3d extent = map.size().cast<double>() * map.resolution();
    for (int i = 0; i < 60; ++i) {
      map.SetOccupied(
          low +
          Eigen::Vector3d{draw.Uniform(0, 1), draw.Uniform(0, 1), draw.Uniform(0, 1)}.cwiseProduct(
              extent));
    }
    FreeSpace space = SpaceOf(map);
    if (trial < 4) space.floor = low.z() + 0.3;
    columns.Begin(space, {});
    ASSERT_EQ(columns.size(), map.size().head<2>());
    int wrong = 0;
    for (int y = 0; y < map.size().y(); ++y) {
      for (int x = 0; x < map.size().x(); ++x) {
        const int count = columns.Count(x, y);
        several += count > 1;
        int id = -1;
        bool free_below = false;
        for (int z = 0; z < map.size().z(); ++z) {
          const CellIndex cell(x, y, z);
          const bool is_free = !space.Blocked(CellIndex(map.origin() + cell));
          if (is_free && !free_below) ++id;
          free_below = is_free;
          wrong += columns.IdAt(cell) != (is_free ? id : -1);
        }
        wrong += count != id + 1;
      }
    }
    EXPECT_EQ(wrong, 0) << "trial " << trial;
  }
  EXPECT_GT(several, 100);
}

TEST(ColumnSpans, TheLowestOnesOfAColumnCount) {
  OccupancyMap map(SmallMap(0.0));
  for (int z = 1; z < map.size().z(); z += 2) {
    map.SetOccupied(map.CentreOf(map.origin() + CellIndex(5, 5, z)));
  }
  ColumnSpans columns;
  const FreeSpace space = SpaceOf(map);
  columns.Begin(space, {});
  ASSERT_EQ(columns.Count(5, 5), ColumnSpans::kMost);
  for (int id = 0; id < ColumnSpans::kMost; ++id) {
    EXPECT_EQ(columns.At(5, 5, id).low, 2 * id);
    EXPECT_EQ(columns.At(5, 5, id).high, 2 * id);
  }
  EXPECT_EQ(columns.IdAt({5, 5, 2 * ColumnSpans::kMost}), -1);
  EXPECT_EQ(columns.Count(6, 5), 1);
}

}  // namespace
}  // namespace touchdown::planning
