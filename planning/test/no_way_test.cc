// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/look/no_way.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "planning/search/span_search.h"
#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

const Eigen::Vector3d kFrom(-2.05, 0.05, 0.05), kTo(2.05, 0.05, 0.05);

/// A wall across the window, with doors from floor to ceiling: y of their first cell, and cells.
OccupancyMap Walled(double inflation, const std::vector<std::pair<double, int>>& doors) {
  OccupancyMap map(SmallMap(inflation));
  for (int j = -32; j < 32; ++j) {
    const double y = 0.1 * j + 0.05;
    bool open = false;
    for (const auto& [from, cells] : doors) open |= y > from && y < from + 0.1 * cells;
    for (int k = -16; k < 16 && !open; ++k) map.SetOccupied({0.05, y, 0.1 * k + 0.05});
  }
  return map;
}

TEST(NoWay, TheWidestOfAllDoorsIsTheNarrowestPlace) {
  const OccupancyMap map = Walled(0.0, {{-2.0, 7}, {0.5, 9}, {2.0, 5}});
  const auto place = FindNarrowPlace(map, kFrom, kTo, -9.0, 9.0);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->width, 0.9, 1e-9);
  EXPECT_NEAR(place->p_W.x(), 0.05, 1e-9);
  EXPECT_NEAR(place->p_W.y(), 0.95, 1e-9);
}

TEST(NoWay, OpenSpaceIsAsWideAsItCounts) {
  OccupancyMap map(SmallMap(0.0));
  const auto place = FindNarrowPlace(map, kFrom, kTo, -9.0, 9.0);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->width, NarrowPlace::kWidest, 0.1 + 1e-9);
}

TEST(NoWay, AClosedWallHasNone) {
  EXPECT_FALSE(FindNarrowPlace(Walled(0.0, {}), kFrom, kTo, -9.0, 9.0));
}

// A goal may be far beyond the wall that is seen.
TEST(NoWay, AnEndBeyondTheWindowCountsAsAtItsBorder) {
  const OccupancyMap open(SmallMap(0.0));
  EXPECT_TRUE(FindNarrowPlace(open, kFrom, {9.0, 0.0, 0.0}, -9.0, 9.0));
  EXPECT_TRUE(FindNarrowPlace(open, kFrom, {2.0, 0.0, -30.0}, -9.0, 9.0)) << "below the window";
}

TEST(NoWay, AnEndThatIsOccupiedHasNoWay) {
  OccupancyMap map(SmallMap(0.0));
  map.SetOccupied(kTo);
  EXPECT_FALSE(FindNarrowPlace(map, kFrom, kTo, -9.0, 9.0));
  EXPECT_FALSE(FindNarrowPlace(map, kTo, kFrom, -9.0, 9.0));
}

TEST(NoWay, EndsCountBetweenFloorAndCeiling) {
  const OccupancyMap map(SmallMap(0.0));
  EXPECT_TRUE(FindNarrowPlace(map, {-2.0, 0.0, -1.5}, {2.0, 0.0, 1.5}, -0.5, 0.5));
}

TEST(NoWay, NothingLeadsBelowTheFloor) {
  OccupancyMap map(SmallMap(0.0));
  for (int j = -32; j < 32; ++j) {  // open below -0.5 m
    for (int k = -5; k < 16; ++k) map.SetOccupied({0.05, 0.1 * j + 0.05, 0.1 * k + 0.05});
  }
  EXPECT_TRUE(FindNarrowPlace(map, kFrom, kTo, -9.0, 9.0));
  EXPECT_FALSE(FindNarrowPlace(map, kFrom, kTo, -0.5, 9.0));
}

// What is called needed is what a search needs: of gaps between straight walls.
TEST(NoWay, TheLeastGapIsTheFirstThatASearchPasses) {
  for (const double inflation : {0.2, 0.4, 0.55}) {
    bool passed = false;
    for (int cells = 1; cells < 20 && !passed; ++cells) {
      const OccupancyMap map = Walled(inflation, {{-0.9, cells}});
      SpanSearch search;
      GuidePath path;
      passed = search.Search(SpaceOf(map), kFrom, kTo, 1000000, &path) == SearchStatus::kFound;
      EXPECT_EQ(passed, 0.1 * cells > LeastGap(map) - 1e-9) << inflation << ", " << cells;
    }
    EXPECT_TRUE(passed);
  }
}

}  // namespace
}  // namespace touchdown::planning
