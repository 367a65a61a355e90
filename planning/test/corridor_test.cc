// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/corridor.h"

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

bool Inside(const std::vector<ObstaclePair>& pairs, const Eigen::Vector3d& p, double by = 0.0) {
  for (const ObstaclePair& pair : pairs) {
    if ((p - pair.p).dot(pair.v) < by) return false;
  }
  return true;
}

// The point keeps its side of every plane. The blocked cells around are on the other side of one,
// except the few that a nearer cell of their row represented.
TEST(Corridor, HoldsThePointAndHardlyABlockedCell) {
  Draw draw(3);
  Corridor corridor(0.3, 0.05);
  int planes = 0, cells = 0, missed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    OccupancyMap map(SmallMap(0.2));
    for (int i = 0; i < 6; ++i) {
      map.SetOccupied({draw.Uniform(-1.0, 1.0), draw.Uniform(-1.0, 1.0), draw.Uniform(-1.0, 1.0)});
    }
    FreeSpace space = SpaceOf(map);
    const Eigen::Vector3d point{draw.Uniform(-0.3, 0.3), draw.Uniform(-0.3, 0.3),
                                draw.Uniform(-0.3, 0.3)};
    if (space.Blocked(point)) continue;
    std::vector<ObstaclePair> pairs;
    corridor.Bind(5, point, space, 12, &pairs);
    planes += static_cast<int>(pairs.size());
    EXPECT_TRUE(Inside(pairs, point));
    for (const ObstaclePair& pair : pairs) {
      EXPECT_EQ(pair.control_point, 5);
      EXPECT_NEAR(pair.v.norm(), 1.0, 1e-12);
    }
    const CellIndex centre = map.CellOf(point);
    CellIndex offset;
    for (offset.z() = -4; offset.z() <= 4; ++offset.z()) {
      for (offset.y() = -4; offset.y() <= 4; ++offset.y()) {
        for (offset.x() = -4; offset.x() <= 4; ++offset.x()) {
          const CellIndex cell = centre + offset;
          if (!space.Blocked(cell) || offset.squaredNorm() > 16) continue;
          ++cells;
          missed += Inside(pairs, map.CentreOf(cell), 0.5 * map.resolution());
        }
      }
    }
  }
  EXPECT_GT(planes, 300);
  EXPECT_GT(cells, 2000);
  EXPECT_LT(missed, 0.02 * cells);
}

TEST(Corridor, TheNearestObstacleComesFirst) {
  OccupancyMap map(SmallMap(0.0));
  map.SetOccupied({0.45, 0.05, 0.05});
  map.SetOccupied({0.05, -0.25, 0.05});
  const FreeSpace space = SpaceOf(map);
  std::vector<ObstaclePair> pairs;
  Corridor(0.3, 0.05).Bind(3, {0.05, 0.05, 0.05}, space, 1, &pairs);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_LT((pairs[0].v - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_NEAR(pairs[0].p.y(), -0.2, 1e-12);
}

TEST(Corridor, FloorAndCeilingAreKeptByTheMarginOnly) {
  OccupancyMap map(SmallMap(0.0));
  FreeSpace space = SpaceOf(map);
  space.floor = -0.3;
  space.ceiling = 0.4;
  std::vector<ObstaclePair> pairs;
  Corridor(0.3, 0.05).Bind(3, Eigen::Vector3d::Zero(), space, 4, &pairs);
  ASSERT_EQ(pairs.size(), 2u);
  // (Q - p) . v >= 0.3 holds from 0.05 m above the floor and below the ceiling on.
  EXPECT_NEAR((Eigen::Vector3d(0, 0, -0.25) - pairs[0].p).dot(pairs[0].v), 0.3, 1e-12);
  EXPECT_NEAR((Eigen::Vector3d(0, 0, 0.35) - pairs[1].p).dot(pairs[1].v), 0.3, 1e-12);
}

TEST(Corridor, ABlockedPointIsLedOut) {
  OccupancyMap map(SmallMap(0.3));
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  std::vector<ObstaclePair> pairs;
  Corridor(0.3, 0.05).Bind(3, {0.15, 0.05, 0.05}, space, 6, &pairs);
  ASSERT_FALSE(pairs.empty());
  EXPECT_FALSE(Inside(pairs, {0.15, 0.05, 0.05}));
}

}  // namespace
}  // namespace touchdown::planning
