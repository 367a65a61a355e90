// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/scene_sets.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "evaluation/studies/replan/replan_scene.h"

namespace touchdown::evaluation {
namespace {

SceneOptions Of(const std::string& set, const std::string& kind) {
  SceneOptions options;
  options.set = set;
  options.kind = SceneKindNamed(kind);
  return options;
}

TEST(SceneSets, EveryOneIsDrawnForEveryKind) {
  for (const std::string& set : SceneSetNames()) {
    for (const SceneKind& kind : SceneKinds()) {
      const SceneOptions options = Of(set, kind.name);
      const ReplanScene a = DrawReplanScene(options, 1), b = DrawReplanScene(options, 1);
      EXPECT_EQ(a.start.p, b.start.p) << set;
      EXPECT_EQ(a.target, b.target) << set;
      EXPECT_FALSE(a.map->IsBlocked(a.start.p)) << set;
      EXPECT_GT(a.field.size(), 0u) << set;
      EXPECT_LT((a.end->At(a.duration).p_WP - a.target).norm(), 1e-5) << set;
      EXPECT_LE(a.start.v.norm(), 0.9 * kind.limits.speed + 1e-12) << set;
    }
  }
  EXPECT_THROW(SceneSetNamed("maze"), std::invalid_argument);
}

TEST(SceneSets, AFastTargetIsAheadAndPassedBelowTheLimit) {
  for (const char* kind : {"A", "C"}) {
    for (int index = 0; index < 8; ++index) {
      const ReplanScene point = DrawReplanScene(Of("point_ahead", kind), index);
      const ReplanScene pad = DrawReplanScene(Of("pad_ahead", kind), index);
      const double limit = SceneKindNamed(kind).limits.speed;
      EXPECT_NEAR((point.target - point.start.p).norm(), 7.5, 0.2);
      EXPECT_LE(point.endpoint.passing_W.norm(), 0.9 * limit + 1e-9);
      EXPECT_GT(point.endpoint.passing_W.norm(), 0.7 * limit);
      EXPECT_EQ(point.end->At(0.0).p_WP, point.end->At(5.0).p_WP);
      EXPECT_EQ(pad.target, point.target);
      EXPECT_EQ(pad.end->At(1.0).v_WP, point.endpoint.passing_W);
      EXPECT_TRUE(pad.endpoint.passing_W.isZero());
    }
  }
}

TEST(SceneSets, ADeadEndIsLeftFromRest) {
  int blocked = 0;
  for (int index = 0; index < 10; ++index) {
    const ReplanScene scene = DrawReplanScene(Of("dead_end", "B"), index);
    EXPECT_TRUE(scene.start.v.isZero());
    blocked += scene.straight_blocked;
  }
  EXPECT_EQ(blocked, 10);
}

TEST(SceneSets, ASlitIsWideEnoughToPass) {
  for (int index = 0; index < 10; ++index) {
    const ReplanScene scene = DrawReplanScene(Of("slits", "A"), index);
    EXPECT_GE(scene.field.size(), 2u);
    EXPECT_LE(scene.field.size(), 4u);
  }
}

TEST(EarliestArrival, IsThatOfFullAccelerationWhereNothingIsInTheWay) {
  ReplanScene scene;
  scene.start.p = {0.0, 0.0, 1.0};
  scene.end =
      std::make_unique<MovingTarget>(Eigen::Vector3d(6.0, 0.0, 1.0), Eigen::Vector3d::Zero(), 0.0);
  scene.endpoint.height = 0.0;
  // From rest to rest over 6 m: a second up to 2 m/s, a second down, 4 m between.
  EXPECT_NEAR(EarliestArrival(scene, {2.0, 2.0}), 4.0, 0.02);
  scene.endpoint.passing_W = {2.0, 0.0, 0.0};  // no need to slow down
  EXPECT_NEAR(EarliestArrival(scene, {2.0, 2.0}), 3.5, 0.02);
  scene.start.v = {2.0, 0.0, 0.0};
  EXPECT_NEAR(EarliestArrival(scene, {2.0, 2.0}), 3.0, 0.02);
  // An end that drives away at half the speed is met after twice the way.
  scene.endpoint.passing_W.setZero();
  scene.end = std::make_unique<MovingTarget>(Eigen::Vector3d(6.0, 0.0, 1.0),
                                             Eigen::Vector3d(1.0, 0.0, 0.0), 0.0);
  EXPECT_NEAR(EarliestArrival(scene, {2.0, 2.0}), 6.25, 0.02);
}

TEST(LearnWithin, TeachesWhatASensorWouldHaveSeen) {
  const ReplanScene scene = DrawReplanScene(Of("crossing", "B"), 0);
  planning::OccupancyMap map(scene.map->options());
  map.MoveWindow(scene.map->origin());
  LearnWithin(*scene.map, scene.start.p, 5.0, &map);
  int near = 0, far = 0;
  planning::CellIndex cell;
  const planning::CellIndex low = map.origin(), high = low + map.size();
  for (cell.z() = low.z(); cell.z() < high.z(); ++cell.z()) {
    for (cell.y() = low.y(); cell.y() < high.y(); cell.y() += 3) {
      for (cell.x() = low.x(); cell.x() < high.x(); cell.x() += 3) {
        const double distance = (map.CentreOf(cell) - scene.start.p).norm();
        if (distance <= 5.0) {
          ASSERT_EQ(map.IsOccupied(cell), scene.map->IsOccupied(cell));
          ASSERT_EQ(map.IsObservedFree(cell), scene.map->IsObservedFree(cell));
          near += map.IsOccupied(cell);
        } else {
          ASSERT_FALSE(map.IsOccupied(cell));
          ASSERT_FALSE(map.IsObservedFree(cell));
          far += scene.map->IsOccupied(cell);
        }
      }
    }
  }
  EXPECT_GT(near, 0);
  EXPECT_GT(far, 0);
}

}  // namespace
}  // namespace touchdown::evaluation
