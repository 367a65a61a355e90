// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/committed_way.h"

#include <gtest/gtest.h>

#include "touchdown/planning/test/planning_fixtures.h"
#include "touchdown/planning/test/small_map.h"

namespace touchdown::planning {
namespace {

constexpr int kEnough = 5000;

/// Across x = 0 from `from` to `to`; the window reaches from -3.2 to 3.2 m.
OccupancyMap Wall(double from, double to) {
  OccupancyMap map(SmallMap(0.1));
  for (double y = from; y < to; y += 0.1) {
    for (double z = -1.55; z < 1.6; z += 0.1) map.SetOccupied({0.05, y, z});
  }
  return map;
}

/// At 1 m/s along x at this y, from t = 0 on.
UniformBspline Along(double y, double x_from = -2.0, double x_to = 2.0) {
  constexpr int kPoints = 43;
  const double h = (x_to - x_from) / (kPoints - 3);
  ControlPoints points(3, kPoints);
  for (int i = 0; i < kPoints; ++i) points.col(i) << x_from + (i - 1) * h, y, 0.05;
  return UniformBspline(points, h, 0.0);
}

class CommittedWayTest : public testing::Test {
 protected:
  int Follow(const UniformBspline& curve, const OccupancyMap& map, int expansions = kEnough) {
    return way_.Follow(curve, 0.0, SpaceOf(map), expansions, &search_);
  }

  GridSearch search_{2.0};
  CommittedWay way_;
};

TEST_F(CommittedWayTest, IsTheCurveItselfWhileThatIsClear) {
  const OccupancyMap map = Wall(-0.55, 0.6);
  const UniformBspline curve = Along(1.5);
  EXPECT_FALSE(way_.known());
  EXPECT_EQ(Follow(curve, map), 0);
  ASSERT_TRUE(way_.known());
  GuidePath guide;
  way_.Sample(0.25, 0.75, &guide);
  EXPECT_NEAR((guide.front() - curve.Evaluate(1.0).p_WB).norm(), 0.0, 1e-9);
  EXPECT_NEAR((guide.back() - curve.Evaluate(3.0).p_WB).norm(), 0.0, 1e-9);
  for (const Eigen::Vector3d& p : guide) EXPECT_NEAR(p.y(), 1.5, 1e-9);
  EXPECT_NEAR((way_.At(0.5) - curve.Evaluate(2.0).p_WB).norm(), 0.0, 1e-9);
  way_.Sample(0.5, 0.5, &guide);
  EXPECT_EQ(guide.size(), 2u);
  way_.Clear();
  EXPECT_FALSE(way_.known());
}

TEST_F(CommittedWayTest, ADetourPassesWhatHasComeToBlockIt) {
  const OccupancyMap map = Wall(-0.55, 0.6);
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Along(0.5);  // it was clear of a wall that seemed shorter
  EXPECT_GT(Follow(curve, map), 0);
  ASSERT_TRUE(way_.known());
  GuidePath guide;
  way_.Sample(0.0, 1.0, &guide);
  double length = PathLength(guide), farthest = 0.0;
  for (const Eigen::Vector3d& p : guide) {
    EXPECT_FALSE(space.Blocked(p)) << p.transpose();
    farthest = std::max(farthest, p.y());
    if (std::abs(p.x()) > 1.0) {
      EXPECT_NEAR(p.y(), 0.5, 1e-9);
    }
  }
  EXPECT_GT(farthest, 0.6);  // around this end, not the other
  EXPECT_LT(length, 5.5);
  // Shares of time go on along the detour.
  for (double share = 0.0; share < 1.0; share += 0.01) {
    EXPECT_LT((way_.At(share + 0.01) - way_.At(share)).norm(), 0.2);
  }
}

TEST_F(CommittedWayTest, KnowsNoWayWhereADetourIsNone) {
  const UniformBspline curve = Along(0.0);
  EXPECT_GT(Follow(curve, Wall(-0.55, 0.6)), 0);
  EXPECT_TRUE(way_.known());
  // Too long.
  Follow(curve, Wall(-2.55, 2.6));
  EXPECT_FALSE(way_.known());
  // No time to look for it.
  EXPECT_LE(Follow(curve, Wall(-0.55, 0.6), 5), 5);
  EXPECT_FALSE(way_.known());
  // Where the curve starts or ends blocked.
  EXPECT_EQ(Follow(Along(0.0, 0.0, 2.0), Wall(-0.55, 0.6)), 0);
  EXPECT_FALSE(way_.known());
  EXPECT_EQ(Follow(Along(0.0, -2.0, 0.0), Wall(-0.55, 0.6)), 0);
  EXPECT_FALSE(way_.known());
}

}  // namespace
}  // namespace touchdown::planning
