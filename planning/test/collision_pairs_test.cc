// SPDX-License-Identifier: BSD-3-Clause
// Pairs point out of the obstacle towards the guide path.

#include "touchdown/planning/collision_pairs.h"

#include <gtest/gtest.h>

#include "touchdown/planning/test/small_map.h"

namespace touchdown::planning {
namespace {

TEST(CollisionPairs, PointOutOfTheObstacleTowardsTheGuide) {
  OccupancyMap map(SmallMap(0.3));
  for (double z = -1.5; z < 1.6; z += 0.1) map.SetOccupied({0.05, 0.05, z});
  const FreeSpace space = SpaceOf(map);
  ControlPoints q(3, 14);
  for (int i = 0; i < 14; ++i) q.col(i) = Eigen::Vector3d(-2.4 + 0.37 * i, 0.02, 0.05);
  const UniformBspline curve(q, 0.2, 0.0);
  std::vector<BlockedRun> runs;
  FindBlockedRuns(curve, 0.0, space, &runs);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_FALSE(runs[0].at_start);
  EXPECT_FALSE(runs[0].at_end);
  GuidePath guide = {{-1.0, 0.0, 0.05}, {0.0, 1.0, 0.05}, {1.0, 0.0, 0.05}};
  std::vector<ObstaclePair> pairs;
  EXPECT_GT(BindPairs(curve, runs[0], guide, space, 50, &pairs), 0);
  for (const ObstaclePair& pair : pairs) {
    EXPECT_GT(pair.v.y(), 0.9);           // the guide passes on the left
    EXPECT_FALSE(space.Blocked(pair.p));  // p is the last free point ...
    EXPECT_TRUE(space.Blocked(Eigen::Vector3d(pair.p - 0.15 * pair.v)));  // ... before the obstacle
  }
}

}  // namespace
}  // namespace touchdown::planning
