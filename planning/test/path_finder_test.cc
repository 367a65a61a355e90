// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/path_finder.h"

#include <gtest/gtest.h>

#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

constexpr double kUp = 2.0;
constexpr int kEnough = 100000;

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

TimedPath Kept(PathFinder* finder, WorkBudget* budget, const UniformBspline& committed,
               const FreeSpace& space, int expansions = kEnough) {
  TimedPath way;
  budget->Refill(expansions);
  finder->Begin(1.0);
  finder->Keep(committed, 0.0, space, &way);
  return way;
}

GuidePath AllOf(const TimedPath& way) {
  GuidePath path;
  way.Sample(way.t0(), way.t_end(), &path);
  return path;
}

/// A straight curve that a wall blocks once.
class PathFinderAtAWall : public ::testing::Test {
 protected:
  const OccupancyMap map = Wall();
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Straight({-2.0, 0.0, 0.05}, {2.0, 0.0, 0.05});
  const BlockedRun run = OnlyRun(curve, space);
  WorkBudget budget;
  PathFinder finder{kUp, {}, &budget};
  TimedPath way;
};

TEST_F(PathFinderAtAWall, LeadsPastARunAndTheOtherWayWhenThatIsClosed) {
  budget.Refill(kEnough);
  finder.Begin(1.0);
  ASSERT_EQ(finder.LeadPast(curve, run, space, &way), SearchStatus::kFound);
  for (const Eigen::Vector3d& p : AllOf(way)) EXPECT_FALSE(space.Blocked(p));
  EXPECT_NEAR((way.AtShare(0.0) - curve.Position(0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((way.AtShare(1.0) - curve.Position(curve.t_end())).norm(), 0.0, 1e-9);
  EXPECT_GT(way.delay(), 0.1);
  const double cost = finder.cost();
  const auto barrier = ClosePath(finder.detour(), curve.Evaluate(0.5 * (run.t_in + run.t_out)));
  ASSERT_TRUE(barrier);
  finder.Close(*barrier);
  EXPECT_EQ(finder.paths_closed(), 1);
  ASSERT_EQ(finder.LeadPast(curve, run, space, &way), SearchStatus::kFound);
  double farthest = 0.0;
  for (const Eigen::Vector3d& p : AllOf(way)) {
    farthest = std::min(farthest, p.y() * barrier->side.y());
  }
  EXPECT_LT(farthest, -0.6);
  // It costs more, and is not considered where that is forbidden.
  EXPECT_EQ(finder.LeadPast(curve, run, space, &way, 0, 0.9 * cost), SearchStatus::kNoPath);
  EXPECT_FALSE(way.known());
  finder.Begin(1.0);
  EXPECT_EQ(finder.paths_closed(), 0);
}

TEST(PathFinder, KeepsTheCommittedCurveWhileItIsClear) {
  const OccupancyMap map = Wall();
  const FreeSpace space = SpaceOf(map);
  const UniformBspline committed = Straight({-2.0, -1.5, 0.05}, {2.0, -1.5, 0.05});
  WorkBudget budget;
  PathFinder finder(kUp, {}, &budget);
  const TimedPath way = Kept(&finder, &budget, committed, space, 0);
  ASSERT_TRUE(way.known());
  EXPECT_TRUE(way.bound().empty());
  for (const Eigen::Vector3d& p : AllOf(way)) EXPECT_NEAR(p.y(), -1.5, 1e-9);
}

TEST(PathFinder, ADetourPassesWhatHasComeToBlockTheCommittedCurve) {
  const OccupancyMap map = Wall();
  const FreeSpace space = SpaceOf(map);
  // It was clear of a wall that seemed shorter.
  const UniformBspline committed = Straight({-2.0, 0.5, 0.05}, {2.0, 0.5, 0.05});
  WorkBudget budget;
  PathFinder finder(kUp, {}, &budget);
  const TimedPath way = Kept(&finder, &budget, committed, space);
  ASSERT_TRUE(way.known());
  EXPECT_EQ(way.bound().size(), 1u);
  double farthest = 0.0;
  for (const Eigen::Vector3d& p : AllOf(way)) {
    EXPECT_FALSE(space.Blocked(p)) << p.transpose();
    farthest = std::max(farthest, p.y());
    if (std::abs(p.x()) > 1.0) {
      EXPECT_NEAR(p.y(), 0.5, 1e-9);
    }
  }
  EXPECT_GT(farthest, 0.6);  // around this end, not the other
  EXPECT_LT(PathLength(AllOf(way)), 5.5);
}

TEST(PathFinder, KeepsNothingWhereADetourIsNone) {
  const OccupancyMap map = Wall();
  OccupancyMap across(SmallMap(0.1));
  for (double y = -2.55; y < 2.6; y += 0.1) {
    for (double z = -1.55; z < 1.6; z += 0.1) across.SetOccupied({0.05, y, z});
  }
  const UniformBspline middle = Straight({-2.0, 0.3, 0.05}, {2.0, 0.3, 0.05});
  WorkBudget budget;
  PathFinder finder(kUp, {}, &budget);
  EXPECT_TRUE(Kept(&finder, &budget, middle, SpaceOf(map)).known());
  EXPECT_FALSE(Kept(&finder, &budget, middle, SpaceOf(across)).known());  // too long
  EXPECT_FALSE(Kept(&finder, &budget, middle, SpaceOf(map), 5).known());  // no time to look for it
  // Where the curve starts or ends blocked.
  const FreeSpace space = SpaceOf(map);
  EXPECT_FALSE(Kept(&finder, &budget, Straight({0.0, 0.0, 0.05}, {2.0, 0.0, 0.05}), space).known());
  EXPECT_FALSE(
      Kept(&finder, &budget, Straight({-2.0, 0.0, 0.05}, {0.0, 0.0, 0.05}), space).known());
}

// The curve enters the front of an obstacle whose back was not seen. Where it is free again it is
// behind the front, and a way that ended there would lead in.
TEST(PathFinder, ARunEndsWhereTheCurveIsOnTheWaysSide) {
  OccupancyMap map = Wall();
  for (double x = 0.05; x < 1.5; x += 0.1) {  // the side that the way passes
    for (double z = -1.55; z < 1.6; z += 0.1) map.SetOccupied({x, -0.55, z});
  }
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Straight({-2.0, 0.0, 0.05}, {2.5, 0.0, 0.05});
  const UniformBspline committed = Straight({-2.0, -1.5, 0.05}, {2.5, -1.5, 0.05});
  BlockedRun run = OnlyRun(curve, space);
  EXPECT_LT(curve.Evaluate(run.t_out).p_WB.x(), 0.5);
  TimedPath way;
  way.AddCurve(committed, 0.0, committed.t_end());
  EndBeside(way, curve, space, 0.5, &run);
  EXPECT_GT(curve.Evaluate(run.t_out).p_WB.x(), 1.5);
  EXPECT_LE(run.t_out, curve.t_end());
  // Nothing is between: the end stays.
  const OccupancyMap plain = Wall();
  BlockedRun short_run = OnlyRun(curve, SpaceOf(plain));
  const double t_out = short_run.t_out;
  const UniformBspline beside = Straight({-2.0, -0.9, 0.05}, {2.5, 0.0, 0.05});
  way.Clear();
  way.AddCurve(beside, 0.0, beside.t_end());
  EndBeside(way, curve, SpaceOf(plain), 0.5, &short_run);
  EXPECT_DOUBLE_EQ(short_run.t_out, t_out);
}

TEST(PathFinder, ARunThatLeavesTheWindowIsCutThere) {
  const OccupancyMap map = Wall();
  const FreeSpace space = SpaceOf(map);
  const UniformBspline curve = Straight({-2.0, 0.0, 0.05}, {6.0, 0.0, 0.05});
  BlockedRun run = OnlyRun(curve, space);
  run.t_out = 7.5;  // at x = 5.5
  WorkBudget budget;
  PathFinder finder(kUp, {}, &budget);
  TimedPath way;
  budget.Refill(kEnough);
  finder.Begin(1.0);
  ASSERT_EQ(finder.LeadPast(curve, run, space, &way), SearchStatus::kFound);
  const double last = finder.detour().back().x();
  EXPECT_TRUE(map.InWindow(map.CellOf(finder.detour().back())));
  EXPECT_GT(last, 3.0);
  EXPECT_NEAR(way.AtShare(1.0).x(), 6.0, 1e-9);
}

TEST(PathFinder, OutOfTheWindowTheWayStaysBetweenFloorAndCeiling) {
  const OccupancyMap map = Wall();
  FreeSpace space = SpaceOf(map);
  space.floor = 0.5;
  space.ceiling = 2.0;
  const UniformBspline curve = Straight({5.0, 0.0, 0.1}, {9.0, 0.0, 2.6});
  WorkBudget budget;
  PathFinder finder(kUp, {}, &budget);
  TimedPath way;
  budget.Refill(kEnough);
  finder.Begin(1.0);
  const BlockedRun all = {0.0, curve.duration(), false, false};
  ASSERT_EQ(finder.LeadPast(curve, all, space, &way), SearchStatus::kEndsOutside);
  ASSERT_GT(finder.detour().size(), 10u);
  for (const Eigen::Vector3d& p : finder.detour()) {
    EXPECT_GT(p.z(), space.floor);
    EXPECT_LT(p.z(), space.ceiling);
  }
}

TEST_F(PathFinderAtAWall, AllSearchesShareTheBudget) {
  budget.Refill(600);
  finder.Begin(1.0);
  int found = 0;
  while (found < 100 && finder.LeadPast(curve, run, space, &way) == SearchStatus::kFound) ++found;
  EXPECT_GT(found, 0);
  EXPECT_LT(found, 60);
}

}  // namespace
}  // namespace touchdown::planning
