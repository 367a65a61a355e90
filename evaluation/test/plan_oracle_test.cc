// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/plan_oracle.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/field_map.h"
#include "evaluation/judge/motion_search.h"
#include "evaluation/studies/replan/oracle_verdicts.h"
#include "evaluation/studies/replan/scene_sets.h"

namespace touchdown::evaluation {
namespace {

using Eigen::Vector3d;

SceneOptions Of(const std::string& set, const std::string& kind) {
  SceneOptions options;
  options.set = set;
  options.kind = SceneKindNamed(kind);
  return options;
}

planning::ReplannerOptions Base() {
  planning::ReplannerOptions base;
  base.problem.terms = planning::StandardTerms();
  return base;
}

TEST(PlanOracle, ItsPlansAreClearAndWithinTheLimits) {
  for (const char* set : {"point_ahead", "slits"}) {
    const SceneOptions options = Of(set, "C");
    PlanOracle oracle(SceneReplannerOptions(options, Base()), solvers::StandardBackends());
    int found = 0;
    for (int index = 0; index < 4; ++index) {
      const ReplanScene scene = DrawReplanScene(options, index);
      const OracleAnswer answer = oracle.Ask(scene);
      if (!answer.plan) continue;
      ++found;
      const PlanCheck check = CheckPlan(*answer.plan, scene, options.kind.limits);
      EXPECT_FALSE(check.map_blocked) << set << ' ' << index;
      EXPECT_FALSE(check.truly_near) << set << ' ' << index;
      EXPECT_FALSE(check.beyond_limits) << set << ' ' << index;
      EXPECT_LT((answer.plan->Position(0.0) - scene.start.p).norm(), 1e-9);
      const double T = answer.plan->duration();
      const planning::SplineState end = planning::EndStateAt(*scene.end, scene.endpoint, T).state;
      EXPECT_LT((answer.plan->AtKnot(answer.plan->segments()).v - end.v).norm(), 1e-8);
      EXPECT_GE(T, EarliestArrival(scene, options.kind.limits));
    }
    EXPECT_GE(found, 2) << set;
  }
}

TEST(PlanOracle, SaysWhyThereIsNone) {
  const SceneOptions options = Of("crossing", "B");
  PlanOracle oracle(SceneReplannerOptions(options, Base()), solvers::StandardBackends());
  ReplanScene scene = DrawReplanScene(options, 0);
  scene.endpoint.height = scene.endpoint.height_floor = -5.0;  // below the floor
  EXPECT_TRUE(oracle.Ask(scene).end_blocked);
  scene = DrawReplanScene(options, 0);
  scene.start.v = {2.0, 0.0, 0.0};
  scene.field = sim::ObstacleField(
      {sim::Box{{scene.start.p.x() + 0.6, scene.start.p.y(), 1.5}, {0.1, 9.0, 1.5}, 0.0}});
  FillMap(scene.field, scene.map.get());
  const OracleAnswer answer = oracle.Ask(scene);
  EXPECT_FALSE(answer.plan);
  EXPECT_TRUE(answer.cannot_stop);
}

TEST(MotionSearch, FindsAWayThatTheStartsSpeedAllows) {
  const SceneOptions options = Of("point_ahead", "C");
  int found = 0;
  for (int index = 0; index < 4; ++index) {
    const ReplanScene scene = DrawReplanScene(options, index);
    planning::FreeSpace space;
    space.map = scene.map.get();
    space.floor = kForestFloor;
    space.ceiling = kForestCeiling;
    const auto way = SearchMotion(scene.start, *scene.end, scene.endpoint, options.kind.limits,
                                  space, MotionSearchOptions());
    if (!way) continue;
    ++found;
    EXPECT_LT((way->front().p - scene.start.p).norm(), 1e-9);
    EXPECT_LT((way->back().p - scene.target).norm(), 1e-6);
    for (std::size_t i = 0; i < way->size(); ++i) {
      EXPECT_FALSE(space.Blocked((*way)[i].p));
      if (i == 0) continue;
      const double time = (*way)[i].t - (*way)[i - 1].t;
      EXPECT_GT(time, 0.0);
      EXPECT_LE(((*way)[i].p - (*way)[i - 1].p).norm(), 1.06 * options.kind.limits.speed * time);
    }
  }
  EXPECT_GE(found, 2);
}

class OracleVerdictsFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = ::testing::TempDir() + "oracle_verdicts_test.csv";
};

TEST_F(OracleVerdictsFile, ReadsBackWhatWasWritten) {
  std::vector<ReplanRow> rows(4);
  rows[0].oracle = OracleVerdict{true, "path"};
  rows[1].oracle = OracleVerdict{true, "motion"};
  rows[2].oracle = OracleVerdict{false, "", true};
  rows[3].oracle = OracleVerdict{false, ""};
  OracleVerdicts verdicts;
  verdicts.Add(Of("slits", "D"), rows);
  verdicts.Write(path_);
  const OracleVerdicts read(path_);
  for (int i = 0; i < 4; ++i) {
    const auto verdict = read.Find(Of("slits", "D"), i);
    ASSERT_TRUE(verdict);
    EXPECT_EQ(verdict->found, rows[static_cast<std::size_t>(i)].oracle->found);
    EXPECT_EQ(verdict->found_by, rows[static_cast<std::size_t>(i)].oracle->found_by);
    EXPECT_EQ(verdict->end_blocked, rows[static_cast<std::size_t>(i)].oracle->end_blocked);
  }
  EXPECT_FALSE(read.Find(Of("slits", "D"), 4));
  EXPECT_FALSE(read.Find(Of("slits", "A"), 0));
  SceneOptions other = Of("slits", "D");
  other.horizon = 8.0;
  EXPECT_FALSE(read.Find(other, 0));
}

TEST_F(OracleVerdictsFile, IsRefusedWithItsLine) {
  const auto refused = [&](const std::string& line) {
    std::ofstream(path_) << "set,kind,seed,verdicts\n" << line << '\n';
    try {
      OracleVerdicts verdicts(path_);
    } catch (const BadInput& error) {
      return std::string(error.what()).find(":2:") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused("slits,A,1"));
  EXPECT_TRUE(refused("slits,A,one,ppp"));
  EXPECT_TRUE(refused("slits,A,1,ppq"));
  EXPECT_FALSE(refused("slits,A,1,ppx"));
}

// The shipped verdicts are those of the oracle for the scenes that this build draws.
TEST(OracleVerdicts, TheShippedOneSaysWhatTheOracleDoes) {
  const OracleVerdicts verdicts = StandardOracleVerdicts();
  for (const std::string& set : SceneSetNames()) {
    const SceneOptions options = Of(set, "C");
    PlanOracle oracle(SceneReplannerOptions(options, Base()), solvers::StandardBackends());
    for (const int index : {0, 299}) {
      const auto verdict = verdicts.Find(options, index);
      ASSERT_TRUE(verdict) << set;
      const OracleAnswer answer = oracle.Ask(DrawReplanScene(options, index));
      EXPECT_EQ(verdict->found, answer.plan.has_value()) << set << ' ' << index;
      EXPECT_EQ(verdict->found_by, answer.found_by) << set << ' ' << index;
    }
  }
}

}  // namespace
}  // namespace touchdown::evaluation
