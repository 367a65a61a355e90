// SPDX-License-Identifier: BSD-3-Clause
#include "planning/replan/pair_binder.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

constexpr int kPoints = 23;
constexpr double kInterval = 0.2;

/// Along x through the origin at 1 m/s, from t = 0 on.
UniformBspline Straight() {
  ControlPoints points(3, kPoints);
  for (int i = 0; i < kPoints; ++i) points.col(i) << (i - 11) * kInterval, 0.03, 0.05;
  return UniformBspline(points, kInterval, 0.0);
}

struct Wall {
  Wall() : map(SmallMap(0.1)), space(SpaceOf(map)), curve(Straight()) {
    for (double y = -0.25; y <= 0.3; y += 0.1) {
      for (double z = -0.75; z < 0.8; z += 0.1) map.SetOccupied({0.05, y, z});
    }
    FindBlockedRuns(curve, 0.0, space, &runs);
    guide = {{-1.0, 0.03, 0.05}, {0.05, 0.9, 0.05}, {1.0, 0.03, 0.05}};
  }
  OccupancyMap map;
  FreeSpace space;
  UniformBspline curve;
  std::vector<BlockedRun> runs;
  GuidePath guide;
};

std::set<int> ControlPointsOf(const std::vector<ObstaclePair>& pairs) {
  std::set<int> bound;
  for (const ObstaclePair& pair : pairs) bound.insert(pair.control_point);
  return bound;
}

TEST(PairBinder, BindsWhatIsBlockedAndBesideItToTheGuidesSide) {
  Wall wall;
  ASSERT_EQ(wall.runs.size(), 1u);
  PairBinder binder{LandingProblemOptions()};
  binder.Begin(kPoints);
  binder.Start(wall.curve);
  binder.Follow(wall.curve, wall.runs.front(), wall.guide, wall.space);
  std::vector<ObstaclePair> pairs;
  binder.Bind(wall.space, &pairs);
  ASSERT_FALSE(pairs.empty());
  const std::set<int> bound = ControlPointsOf(pairs);
  for (const int i : bound) {
    const double t = (i - 1) * kInterval;
    EXPECT_GT(t, wall.runs.front().t_in - 3 * kInterval);
    EXPECT_LT(t, wall.runs.front().t_out + 3 * kInterval);
  }
  // Where the curve is blocked some plane of every control point pushes it to the guide's side.
  for (const int i : bound) {
    const double t = (i - 1) * kInterval;
    if (t < wall.runs.front().t_in || t > wall.runs.front().t_out) continue;
    bool pushed_left = false;
    for (const ObstaclePair& pair : pairs) {
      pushed_left = pushed_left || (pair.control_point == i && pair.v.y() > 0.5 &&
                                    (wall.curve.Evaluate(t).p_WB - pair.p).dot(pair.v) < 0.0);
    }
    EXPECT_TRUE(pushed_left) << "control point " << i;
  }
  // What was bound stays bound, around the new curve.
  std::vector<ObstaclePair> again;
  binder.Start(wall.curve);
  binder.Bind(wall.space, &again);
  const std::set<int> still = ControlPointsOf(again);
  EXPECT_TRUE(std::includes(still.begin(), still.end(), bound.begin(), bound.end()));
  binder.Begin(kPoints);
  binder.Start(wall.curve);
  binder.Bind(wall.space, &again);
  EXPECT_TRUE(again.empty());
}

TEST(PairBinder, ACornerBindsBothControlPointsBesideIt) {
  Wall wall;
  PairBinder binder{LandingProblemOptions()};
  binder.Begin(kPoints);
  binder.Start(wall.curve);
  binder.AddCorner(wall.curve, wall.runs.front(), wall.guide, wall.space);
  std::vector<ObstaclePair> pairs;
  binder.Bind(wall.space, &pairs);
  const std::set<int> bound = ControlPointsOf(pairs);
  ASSERT_EQ(bound.size(), 2u);
  EXPECT_EQ(*bound.rbegin(), *bound.begin() + 1);
}

TEST(PairBinder, NeverGivesMorePairsThanTheProblemHolds) {
  Wall wall;
  for (const int per_point : {2, 3}) {
    LandingProblemOptions options;
    options.max_pairs_per_point = per_point;
    const LandingProblem problem(kPoints - 3, options);
    PairBinder binder(options);
    binder.Begin(kPoints);
    binder.Start(wall.curve);
    for (int i = 0; i < 40; ++i) {
      binder.AddCorner(wall.curve, wall.runs.front(), wall.guide, wall.space);
    }
    binder.Follow(wall.curve, {0.0, 4.0, false, false}, wall.guide, wall.space);
    std::vector<ObstaclePair> pairs;
    binder.Bind(wall.space, &pairs);
    EXPECT_LE(static_cast<int>(pairs.size()), problem.max_pairs());
  }
}

// A detour takes longer than what it replaces: control points are wanted on it in even steps of that time.
TEST(PairBinder, AWayIsBoundAlongItsDetourAndBesideIt) {
  Wall wall;
  TimedPath way;
  const BlockedRun& run = wall.runs.front();
  way.AddCurve(wall.curve, 0.0, run.t_in);
  way.AddDetour(wall.curve, run, wall.guide, 1.0);
  way.AddCurve(wall.curve, run.t_out, wall.curve.t_end());
  ASSERT_GT(way.delay(), 0.5);
  PairBinder binder{LandingProblemOptions()};
  binder.Begin(kPoints);
  binder.Lead(way, {});
  std::vector<ObstaclePair> pairs;
  binder.Bind(wall.space, &pairs);
  const double interval = (way.t_end() - way.t0()) / (kPoints - 3);
  ASSERT_FALSE(pairs.empty());
  for (const ObstaclePair& pair : pairs) {
    const double t = way.t0() + (pair.control_point - 1) * interval;
    EXPECT_GT(t, way.bound().front().from - 2.5 * interval);
    EXPECT_LT(t, way.bound().front().to + 2.5 * interval);
    EXPECT_GT((way.At(t) - pair.p).dot(pair.v), 0.0);  // the side of the way
  }
}

TEST(PairBinder, RefusesWhatItCannotHold) {
  LandingProblemOptions options;
  options.max_pairs_per_point = 1;
  EXPECT_THROW(PairBinder{options}, std::invalid_argument);
  PairBinder binder{LandingProblemOptions()};
  EXPECT_THROW(binder.Begin(PairBinder::kMostControlPoints + 1), std::invalid_argument);
}

TEST(PairBinder, WhatWasBoundIsBoundAgainOnTheRestOfTheCurve) {
  Wall wall;
  PairBinder binder{LandingProblemOptions()};
  binder.Begin(kPoints);
  binder.Start(wall.curve);
  binder.Follow(wall.curve, wall.runs.front(), wall.guide, wall.space);
  binder.AddCorner(wall.curve, wall.runs.front(), wall.guide, wall.space);
  std::vector<ObstaclePair> pairs;
  binder.Bind(wall.space, &pairs);
  const std::set<int> before = ControlPointsOf(pairs);
  BoundParts parts;
  binder.Remember(wall.curve, &parts);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_LT(parts[0].from, parts[0].to);
  EXPECT_EQ(parts[1].from, parts[1].to);

  // Two intervals later, on a curve that keeps off the wall.
  constexpr int kGone = 2;
  ControlPoints rest = wall.curve.control_points().rightCols(kPoints - kGone);
  rest.row(1).array() += 0.5;
  const UniformBspline later(rest, kInterval, kGone * kInterval);
  TimedPath way;
  way.AddCurve(later, later.t0(), later.t_end());
  binder.Begin(kPoints - kGone);
  binder.Lead(way, parts);
  binder.Bind(wall.space, &pairs);
  std::set<int> after;
  for (const int i : ControlPointsOf(pairs)) after.insert(i + kGone);
  // What needed no pairs on the way along the guide may need some here.
  EXPECT_TRUE(std::includes(after.begin(), after.end(), before.begin(), before.end()));
  EXPECT_EQ(*after.begin(), *before.begin());
  EXPECT_EQ(*after.rbegin(), *before.rbegin());
  for (const ObstaclePair& pair : pairs) {  // to the side on which the curve is
    const double t = later.t0() + (pair.control_point - 1) * kInterval;
    EXPECT_GT((later.Position(t) - pair.p).dot(pair.v), 0.0);
  }
  // Parts in the past are forgotten.
  binder.Begin(kPoints - kGone);
  binder.Lead(way, {{-1.0, -0.5}, {-2.0, -2.0}});
  binder.Bind(wall.space, &pairs);
  EXPECT_TRUE(pairs.empty());
}

}  // namespace
}  // namespace touchdown::planning
