// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/replan_study.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/studies/replan/replan_growth.h"

namespace touchdown::evaluation {
namespace {

ReplanStudyOptions Options(const std::string& kind, int count) {
  ReplanStudyOptions options;
  options.scenes.kind = SceneKindNamed(kind);
  options.replanner.problem.terms = planning::StandardTerms();
  options.count = count;
  options.repeats = 1;
  return options;
}

std::vector<ReplanRow> Steps(const ReplanStudyOptions& options) {
  return RunReplanStudy(options, solvers::StandardBackends(), [](int, int) {});
}

TEST(ReplanStudy, NoAcceptedPlanCollidesOrExceedsALimit) {
  for (const char* kind : {"A", "B", "C", "D"}) {
    const ReplanSummary summary = Summarise(Steps(Options(kind, 15)));
    EXPECT_EQ(summary.scenes, 15);
    EXPECT_GE(summary.accepted, 10) << kind;
    EXPECT_EQ(summary.checked, summary.accepted) << kind;
    EXPECT_GE(summary.feasible, 10) << kind;
    EXPECT_LE(summary.succeeded, summary.feasible) << kind;
    EXPECT_EQ(summary.colliding, 0) << kind;
    EXPECT_EQ(summary.disagreeing, 0) << kind;
    EXPECT_EQ(summary.beyond_limits, 0) << kind;
    EXPECT_EQ(summary.clear.count + summary.blocked.count, summary.all.count);
  }
}

TEST(ReplanStudy, BothCheckersSeeAPlanThroughAnObstacle) {
  const ReplanStudyOptions options = Options("B", 1);
  int through = 0;
  for (int index = 0; index < 30; ++index) {
    const ReplanScene scene = DrawReplanScene(options.scenes, index);
    planning::ControlPoints points(3, 4);
    for (int i = 0; i < 4; ++i) {
      points.col(i) = scene.start.p + (i - 1) * (scene.target - scene.start.p);
    }
    const PlanCheck row =
        CheckPlan(planning::UniformBspline(points, 5.0, 0.0), scene, options.scenes.kind.limits);
    EXPECT_NEAR(row.length, (scene.target - scene.start.p).norm(), 1e-6);
    EXPECT_EQ(row.map_blocked, scene.straight_blocked) << index;
    // A cell is at most its diagonal larger than the obstacle in it.
    if (row.truly_near) {
      EXPECT_TRUE(row.map_blocked) << index;
    } else if (row.map_blocked) {
      EXPECT_LT(row.true_clearance, options.scenes.kind.inflation + 0.18) << index;
    }
    through += row.truly_near;
  }
  EXPECT_GE(through, 5);
}

TEST(ReplanStudy, LimitsAreLookedAtOnTheCurveItself) {
  const ReplanStudyOptions options = Options("B", 1);
  const ReplanScene scene = DrawReplanScene(options.scenes, 0);
  planning::ControlPoints points(3, 8);  // at 1 m/s along x, with a jump in the middle
  for (int i = 0; i < 8; ++i) points.col(i) << scene.start.p.x() + i, scene.start.p.y(), 1.0;
  const auto check = [&](const planning::Limits& limits) {
    return CheckPlan(planning::UniformBspline(points, 1.0, 0.0), scene, limits).beyond_limits;
  };
  EXPECT_FALSE(check({1.0, 0.1}));
  EXPECT_TRUE(check({0.9, 0.1}));
  points(1, 4) += 0.5;
  EXPECT_TRUE(check({5.0, 0.1}));
  EXPECT_FALSE(check({5.0, 5.0}));
}

TEST(ReplanStudy, NothingIsSaidOfPlansThatWereNotLookedAt) {
  ReplanStudyOptions options = Options("B", 4);
  options.check = false;
  const ReplanSummary summary = Summarise(Steps(options));
  EXPECT_GT(summary.accepted, 0);
  EXPECT_EQ(summary.checked, 0);
}

TEST(ReplanStudy, RepeatsButForItsTimes) {
  const std::vector<ReplanRow> a = Steps(Options("C", 6)), b = Steps(Options("C", 6));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].status, b[i].status);
    EXPECT_EQ(a[i].pairs, b[i].pairs);
    EXPECT_EQ(a[i].solves, b[i].solves);
    EXPECT_EQ(a[i].jerk, b[i].jerk);
    ASSERT_EQ(a[i].check.has_value(), b[i].check.has_value());
    if (!a[i].check) continue;
    EXPECT_EQ(a[i].check->length, b[i].check->length);
    EXPECT_EQ(a[i].check->true_clearance, b[i].check->true_clearance);
  }
}

TEST(ReplanGrowth, VariesOneThingAtATime) {
  const ReplanStudyOptions usual = Options("C", 7);
  for (const GrowthPoint& point : GrowthPoints(usual)) {
    const SceneOptions& scenes = point.options.scenes;
    EXPECT_GT(VariedValue(point.varied, scenes), 0.0);
    const int changed = (scenes.horizon != usual.scenes.horizon) +
                        (scenes.density != usual.scenes.density) +
                        (scenes.resolution != usual.scenes.resolution);
    EXPECT_LE(changed, 1);
    EXPECT_EQ(point.options.count, 7);
  }
  EXPECT_THROW(VariedValue("wind", usual.scenes), std::invalid_argument);
}

TEST(ReplanGrowth, ClassesOfPairsHoldEveryRow) {
  std::vector<ReplanRow> rows;
  for (const int pairs : {0, 1, 4, 5, 8, 9, 40}) rows.emplace_back().pairs = pairs;
  const std::vector<PairClass> classes = TimesByPairs(rows);
  std::vector<std::array<int, 3>> found;
  for (const PairClass& one : classes) found.push_back({one.from, one.to, one.time.count});
  using Class = std::array<int, 3>;
  EXPECT_THAT(found, ::testing::ElementsAre(Class{0, 0, 1}, Class{1, 4, 2}, Class{5, 8, 2},
                                            Class{9, 16, 1}, Class{33, 64, 1}));
}

}  // namespace
}  // namespace touchdown::evaluation
