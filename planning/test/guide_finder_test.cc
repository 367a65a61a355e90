// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/guide_finder.h"

#include <gtest/gtest.h>

#include "touchdown/planning/test/small_map.h"

namespace touchdown::planning {
namespace {

constexpr double kUp = 2.0;

/// At 1 m/s from t = 0 on.
UniformBspline Straight(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr int kPoints = 43;
  const double h = (to - from).norm() / (kPoints - 3);
  ControlPoints points(3, kPoints);
  for (int i = 0; i < kPoints; ++i) points.col(i) = from + (i - 1) * h * (to - from).normalized();
  return UniformBspline(points, h, 0.0);
}

/// Across x = 0, 1.2 m wide; the window reaches from -3.2 to 3.2 m.
OccupancyMap Wall() {
  OccupancyMap map(SmallMap(0.1));
  for (double y = -0.55; y < 0.6; y += 0.1) {
    for (double z = -1.55; z < 1.6; z += 0.1) map.SetOccupied({0.05, y, z});
  }
  return map;
}

BlockedRun OnlyRun(const UniformBspline& curve, const FreeSpace& space) {
  std::vector<BlockedRun> runs;
  FindBlockedRuns(curve, 0.0, space, &runs);
  EXPECT_EQ(runs.size(), 1u);
  return runs.front();
}

TEST(GuideFinder, KeepsToTheCommittedCurveUntilAWayIsClosed) {
  const OccupancyMap map = Wall();
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Straight({-2.0, 0.0, 0.05}, {2.0, 0.0, 0.05});
  const UniformBspline committed = Straight({-2.0, -1.5, 0.05}, {2.0, -1.5, 0.05});
  BlockedRun run = OnlyRun(curve, space);
  GuideFinder finder(kUp);
  GuidePath guide;
  finder.Refill(100000);
  finder.Begin(false);
  EXPECT_FALSE(finder.Keeps(run));
  finder.Keep(committed, 0.0, space);
  EXPECT_TRUE(finder.Keeps(run));
  ASSERT_EQ(finder.Find(space, curve, /*local=*/false, &run, &guide), SearchStatus::kFound);
  for (const Eigen::Vector3d& p : guide) EXPECT_NEAR(p.y(), -1.5, 1e-9);
  EXPECT_NEAR(guide.front().x(), curve.Evaluate(run.t_in).p_WB.x(), 1e-9);
  // That side is closed: A* has to take the other.
  finder.Close({{0.05, 0.0, 0.05}, Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY()});
  EXPECT_FALSE(finder.Keeps(run));
  ASSERT_EQ(finder.Find(space, curve, /*local=*/false, &run, &guide), SearchStatus::kFound);
  double highest = 0.0;
  for (const Eigen::Vector3d& p : guide) {
    EXPECT_FALSE(space.Blocked(p));
    highest = std::max(highest, p.y());
  }
  EXPECT_GT(highest, 0.6);
  finder.Refill(100000);
  finder.Begin(false);
  EXPECT_EQ(finder.ways_closed(), 0);
  EXPECT_FALSE(finder.Keeps(run));
}

// The curve enters the front of an obstacle whose back was not seen: where it is free again it is behind the
// front, and a guide that ended there would lead in.
TEST(GuideFinder, ARunEndsWhereTheCurveIsOnTheCommittedSide) {
  OccupancyMap map = Wall();
  for (double x = 0.05; x < 1.5; x += 0.1) {  // the side that the committed curve passes
    for (double z = -1.55; z < 1.6; z += 0.1) map.SetOccupied({x, -0.55, z});
  }
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Straight({-2.0, 0.0, 0.05}, {2.5, 0.0, 0.05});
  const UniformBspline committed = Straight({-2.0, -1.5, 0.05}, {2.5, -1.5, 0.05});
  BlockedRun run = OnlyRun(curve, space);
  EXPECT_LT(curve.Evaluate(run.t_out).p_WB.x(), 0.5);
  GuideFinder finder(kUp);
  finder.Refill(100000);
  finder.Begin(false);
  finder.Keep(committed, 0.0, space);
  ASSERT_TRUE(finder.Keeps(run));
  finder.EndBesideKept(space, curve, &run);
  EXPECT_GT(curve.Evaluate(run.t_out).p_WB.x(), 1.5);
  EXPECT_LE(run.t_out, curve.t_end());
  // Nothing is between: it ends where it ended.
  const OccupancyMap plain = Wall();
  BlockedRun short_run = OnlyRun(curve, SpaceOf(plain));
  const double t_out = short_run.t_out;
  const UniformBspline beside = Straight({-2.0, -0.9, 0.05}, {2.5, 0.0, 0.05});
  finder.Refill(100000);
  finder.Begin(false);
  finder.Keep(beside, 0.0, SpaceOf(plain));
  ASSERT_TRUE(finder.Keeps(short_run));
  finder.EndBesideKept(SpaceOf(plain), curve, &short_run);
  EXPECT_DOUBLE_EQ(short_run.t_out, t_out);
}

TEST(GuideFinder, ARunThatLeavesTheWindowEndsInIt) {
  const OccupancyMap map = Wall();
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Straight({-2.0, 0.0, 0.05}, {6.0, 0.0, 0.05});
  BlockedRun run = OnlyRun(curve, space);
  run.t_out = 7.5;  // at x = 5.5
  GuideFinder finder(kUp);
  GuidePath guide;
  finder.Refill(100000);
  finder.Begin(false);
  ASSERT_EQ(finder.Find(space, curve, /*local=*/false, &run, &guide), SearchStatus::kFound);
  EXPECT_TRUE(map.InWindow(map.CellOf(curve.Evaluate(run.t_out).p_WB)));
  EXPECT_GT(curve.Evaluate(run.t_out).p_WB.x(), 3.0);
}

TEST(GuideFinder, OutOfTheWindowTheGuideStaysBetweenFloorAndCeiling) {
  const OccupancyMap map = Wall();
  FreeSpace space = SpaceOf(map);
  space.floor = 0.5;
  space.ceiling = 2.0;
  const UniformBspline curve = Straight({5.0, 0.0, 0.1}, {9.0, 0.0, 2.6});
  BlockedRun run = {0.0, curve.duration(), false, false};
  GuideFinder finder(kUp);
  GuidePath guide;
  finder.Refill(100000);
  finder.Begin(false);
  ASSERT_EQ(finder.Find(space, curve, /*local=*/false, &run, &guide), SearchStatus::kEndsOutside);
  ASSERT_GT(guide.size(), 10u);
  for (const Eigen::Vector3d& p : guide) {
    EXPECT_GT(p.z(), space.floor);
    EXPECT_LT(p.z(), space.ceiling);
  }
}

TEST(GuideFinder, AllSearchesOfAnAttemptShareTheBudget) {
  const OccupancyMap map = Wall();
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Straight({-2.0, 0.0, 0.05}, {2.0, 0.0, 0.05});
  GuideFinder finder(kUp);
  GuidePath guide;
  finder.Refill(60);
  finder.Begin(false);
  BlockedRun run = OnlyRun(curve, space);
  int found = 0;
  while (found < 100 &&
         finder.Find(space, curve, /*local=*/false, &run, &guide) == SearchStatus::kFound)
    ++found;
  EXPECT_GT(found, 0);
  EXPECT_LT(found, 60);
}

}  // namespace
}  // namespace touchdown::planning
