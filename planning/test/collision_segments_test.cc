// SPDX-License-Identifier: BSD-3-Clause
// Stretches of a polygon in obstacles, at its end too, and the pairs they are given.
#include "planning/baselines/ego/collision_segments.h"

#include <vector>

#include <gtest/gtest.h>

#include "planning/test/ego_fixtures.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

/// Control points every `spacing` along x.
ControlPoints Line(int n, double spacing) {
  ControlPoints q(3, n);
  for (int i = 0; i < n; ++i) q.col(i) = Vector3d(-4.0 + spacing * i, 0.0, 1.0);
  return q;
}

TEST(FindCollisionSegments, EncloseABlockedStretchBetweenFreePoints) {
  CubeGrid grid = EmptyGrid();
  AddBox({-2.0, -0.3, 0}, {-1.4, 0.3, 3}, &grid);
  const ControlPoints q = Line(21, 0.4);
  const auto segments = FindCollisionSegments(q, grid);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_FALSE(grid.Occupied(q.col(segments[0].in)));
  EXPECT_FALSE(grid.Occupied(q.col(segments[0].out)));
  EXPECT_LT(q(0, segments[0].in), -2.0);
  EXPECT_GT(q(0, segments[0].out), -1.4);
}

TEST(FindCollisionSegments, LeaveOutAStretchThatTheScanDoesNotSeeTheEndOf) {
  CubeGrid grid = EmptyGrid();
  AddBox({-0.5, -0.3, 0}, {9.0, 0.3, 3}, &grid);
  EXPECT_TRUE(FindCollisionSegments(Line(21, 0.4), grid).empty());
}

TEST(FindCollisionSegments, EndWhereAllPointsAreOne) {
  CubeGrid grid = EmptyGrid();
  AddBox({-4.2, -0.3, 0}, {-3.8, 0.3, 3}, &grid);
  EXPECT_TRUE(FindCollisionSegments(Line(12, 0.0), grid).empty());
}

TEST(FindNewObstacles, SayWhenNothingFreeFollows) {
  CubeGrid grid = EmptyGrid();
  AddBox({-1.0, -0.3, 0}, {9.0, 0.3, 3}, &grid);
  const ControlPoints q = Line(21, 0.4);
  std::vector<CollisionSegment> segments;
  EXPECT_FALSE(FindNewObstacles(q, grid, SurfacePairs(21), &segments));

  CubeGrid closed = EmptyGrid();
  AddBox({-2.0, -0.3, 0}, {-1.4, 0.3, 3}, &closed);
  EXPECT_TRUE(FindNewObstacles(q, closed, SurfacePairs(21), &segments));
  EXPECT_EQ(segments.size(), 1u);
}

TEST(FindNewObstacles, SkipPointsThatTheirPairsSpeakOf) {
  CubeGrid grid = EmptyGrid();
  AddBox({-2.0, -0.3, 0}, {-1.4, 0.3, 3}, &grid);
  const ControlPoints q = Line(21, 0.4);
  SurfacePairs pairs(21);
  for (int i = 0; i < 21; ++i) pairs[i] = {{q.col(i) + 0.5 * Vector3d::UnitY(), Vector3d::UnitY()}};
  std::vector<CollisionSegment> segments;
  EXPECT_TRUE(FindNewObstacles(q, grid, pairs, &segments));
  EXPECT_TRUE(segments.empty());
}

TEST(BindSurfacePairs, NamesALookupInAnEmptyList) {
  // The path passes through control point 5, which gives no direction, and ends before 6.
  ControlPoints q(3, 12);
  for (int i = 0; i < 12; ++i) q.col(i) = Vector3d(i, 0, 0);
  const std::vector<Vector3d> path = {{4.5, 0, 0}, {5.0, 0, 0}, {5.5, 0, 0}};
  SurfacePairs pairs(12);
  EXPECT_FALSE(BindSurfacePairs(q, {4, 7}, path, EmptyGrid(), &pairs));
}

}  // namespace
}  // namespace touchdown::planning
