// SPDX-License-Identifier: BSD-3-Clause
#include "planning/look/far_memory.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "planning/search/span_search.h"
#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

/// A wall as high as the window, cell by cell.
void Wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to, OccupancyMap* map) {
  const int steps = static_cast<int>((to - from).norm() / 0.05);
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = from + (to - from) * i / steps;
    for (double z = 0.05; z < 6.0; z += 0.1) map->SetOccupied({p.x(), p.y(), z});
  }
}

OccupancyMap MapAt(const Eigen::Vector3d& p_W) {
  OccupancyMap map{OccupancyMapOptions{}};
  map.Recentre(p_W);
  return map;
}

TEST(FarMemory, KeepsWhatLeavesTheWindowUntilItIsSeenFree) {
  const Eigen::Vector3d here(0.05, 0.05, 2.05), away(40.05, 0.05, 2.05), wall(5.05, 0.05, 2.05);
  OccupancyMap map = MapAt(here);
  Wall({5.05, -3.0}, {5.05, 3.0}, &map);
  FarMemory memory(map, 0.0);
  memory.Keep(map);
  EXPECT_TRUE(memory.map().IsBlocked(wall));
  EXPECT_FALSE(memory.map().IsBlocked(here));

  OccupancyMap elsewhere = MapAt(away);
  memory.Keep(elsewhere);
  EXPECT_TRUE(memory.map().IsBlocked(wall));

  OccupancyMap back = MapAt(here);
  memory.Keep(back);
  EXPECT_TRUE(memory.map().IsBlocked(wall)) << "not seen is not free";
  back.MarkRestFree();
  memory.Keep(back);
  EXPECT_FALSE(memory.map().IsBlocked(wall));
}

TEST(FarMemory, ForgetsWhatIsTooFar) {
  OccupancyMap map = MapAt({0.05, 0.05, 2.05});
  Wall({5.05, -3.0}, {5.05, 3.0}, &map);
  FarMemory memory(map, 0.0);
  memory.Keep(map);
  memory.Keep(MapAt({100.05, 0.05, 2.05}));
  memory.Keep(MapAt({0.05, 0.05, 2.05}));
  EXPECT_FALSE(memory.map().IsBlocked(Eigen::Vector3d(5.05, 0.05, 2.05)));
}

TEST(FarMemory, HoldsEachHeightFromTheFloorUp) {
  for (const double floor : {-7.0, 0.0, 3.0}) {
    OccupancyMap map = MapAt({0.05, 0.05, floor + 2.0});
    const Eigen::Vector3d low(2.05, 0.05, floor + 0.55), high(2.05, 0.05, floor + 4.05);
    map.SetOccupied(low);
    map.SetOccupied(high);
    FarMemory memory(map, floor);
    memory.Keep(map);
    EXPECT_TRUE(memory.map().IsBlocked(low)) << floor;
    EXPECT_TRUE(memory.map().IsBlocked(high)) << floor;
    EXPECT_FALSE(memory.map().IsBlocked(Eigen::Vector3d(2.05, 0.05, floor + 2.3))) << floor;
  }
}

// Walls at any angle stay closed, with gaps that are too narrow by two cells.
TEST(FarMemory, NothingClosedIsOpen) {
  Draw draw(77);
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Vector3d here(draw.Uniform(-9, 9), draw.Uniform(-9, 9), 2.05);
    OccupancyMap map = MapAt(here);
    const double angle = draw.Uniform(0.0, M_PI), gap = trial % 2 == 0 ? 0.0 : 0.9;
    const Eigen::Rotation2Dd turn(angle);
    const auto at = [&](double x, double y) -> Eigen::Vector2d {
      return here.head<2>() + turn * Eigen::Vector2d(x, y);
    };
    for (const double side : {-4.0, 4.0}) {
      Wall(at(side, -4.0), at(side, -0.5 * gap), &map);
      Wall(at(side, 0.5 * gap), at(side, 4.0), &map);
      Wall(at(-4.0, side), at(4.0, side), &map);
    }
    FarMemory memory(map, 0.0);
    memory.Keep(map);
    FreeSpace space;
    space.ceiling = 5.0;
    SpanSearch search;
    for (const OccupancyMap* of : {static_cast<const OccupancyMap*>(&map), &memory.map()}) {
      space.map = of;
      EXPECT_EQ(search.Escape(space, here, 1000000), SearchStatus::kNoPath) << trial;
    }
  }
}

}  // namespace
}  // namespace touchdown::planning
