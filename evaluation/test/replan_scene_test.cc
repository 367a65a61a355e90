// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/replan_scene.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

SceneOptions OfKind(const std::string& kind) {
  SceneOptions options;
  options.kind = SceneKindNamed(kind);
  return options;
}

TEST(ReplanScene, AllKindsAreDrawnAsDescribed) {
  for (const SceneKind& kind : SceneKinds()) {
    int feasible = 0, blocked = 0;
    double fastest = 0.0;
    for (int index = 0; index < 12; ++index) {
      const ReplanScene scene = DrawReplanScene(OfKind(kind.name), index);
      EXPECT_LE(scene.start.v.norm(), 0.8 * kind.limits.speed);
      EXPECT_FALSE(scene.map->IsBlocked(scene.start.p));
      const Eigen::Vector3d way = scene.target - scene.start.p;
      EXPECT_NEAR(way.norm(), 7.5, scene.target_moved + 1e-9);
      // The end is at the target when the guessed duration is over, and moves along the way.
      const estimation::PadState end = scene.end->At(scene.duration);
      EXPECT_LT((end.p_WP - scene.target).norm(), 1e-9);
      EXPECT_LE(end.v_WP.norm(), 0.5 * kind.limits.speed);
      fastest = std::max(fastest, end.v_WP.norm());
      if (scene.feasible) {
        EXPECT_FALSE(scene.map->IsBlocked(scene.target));
        EXPECT_LT(scene.target_moved, 1.0);
      }
      feasible += scene.feasible;
      blocked += scene.straight_blocked;
    }
    EXPECT_GE(feasible, 8) << kind.name;
    EXPECT_GE(blocked, 2) << kind.name;
    EXPECT_GT(fastest, 0.3 * kind.limits.speed) << kind.name;
  }
}

TEST(ReplanScene, AnIndexAndASeedAlwaysGiveTheSameScene) {
  const ReplanScene a = DrawReplanScene(OfKind("A"), 3), b = DrawReplanScene(OfKind("A"), 3);
  EXPECT_EQ(a.start.p, b.start.p);
  EXPECT_EQ(a.start.v, b.start.v);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.duration, b.duration);
  std::vector<planning::CellState> cells_a, cells_b;
  a.map->CopyStates(&cells_a);
  b.map->CopyStates(&cells_b);
  EXPECT_EQ(cells_a, cells_b);
  EXPECT_NE(DrawReplanScene(OfKind("A"), 4).start.p, a.start.p);
  SceneOptions other = OfKind("A");
  other.seed = 2;
  EXPECT_NE(DrawReplanScene(other, 3).start.p, a.start.p);
}

TEST(ReplanScene, AnUnknownKindIsRefused) {
  EXPECT_THROW(SceneKindNamed("E"), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::evaluation
