// SPDX-License-Identifier: BSD-3-Clause
// Plan calls of the EGO-Planner baseline: every outcome has its name, none crashes, the same call
// gives the same plan.
#include "planning/baselines/ego/ego_plan.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "planning/test/ego_fixtures.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

TEST(EgoPlan, AnEmptyMapTakesTheFirstGuess) {
  EgoPlan plan({});
  const EgoRequest request = Ahead();
  const EgoPlanResult result = plan.Run(EmptyGrid(), request);
  ASSERT_EQ(result.status, EgoStatus::kPlanned);
  EXPECT_EQ(result.counts.runs, 1);
  EXPECT_EQ(result.counts.searches, 0);
  EXPECT_DOUBLE_EQ(result.curve.t0(), 3.0);
  const FlatState start = result.curve.Evaluate(3.0);
  EXPECT_LT((start.p_WB - request.ends.start.p).norm(), 2e-3);
  EXPECT_LT((start.v_WB - request.ends.start.v).norm(), 5e-3);
}

TEST(EgoPlan, GoesAroundAPillar) {
  CubeGrid grid = EmptyGrid();
  AddBox({-1.3, -0.2, 0}, {-0.9, 0.3, 3}, &grid);
  EgoPlan plan({});
  const EgoPlanResult result = plan.Run(grid, Ahead());
  ASSERT_EQ(result.status, EgoStatus::kPlanned) << Explain(result.status);
  EXPECT_GT(result.counts.searches, 0);
  const double T = result.curve.duration();
  for (double t = 0.0; t < 2.0 / 3.0 * T; t += 0.1) {
    EXPECT_FALSE(grid.Occupied(result.curve.Evaluate(3.0 + t).p_WB));
  }
}

TEST(EgoPlan, SlowsDownWhereTheFirstGuessIsTooFast) {
  EgoRequest request = Ahead();
  request.ends.start.v = {-2, 0, 0};
  EgoPlan plan({});
  const EgoPlanResult result = plan.Run(EmptyGrid(), request);
  ASSERT_EQ(result.status, EgoStatus::kPlanned);
  EXPECT_TRUE(result.refined);
  EXPECT_GT(result.refine_iterations, 0);
  EXPECT_GT(result.curve.duration(), 4.32 + 0.1);
}

TEST(EgoPlan, EveryDeadEndHasItsName) {
  CubeGrid grid = EmptyGrid();
  EgoPlan plan({});
  EXPECT_EQ(plan.Run(grid, Ahead(0.1)).status, EgoStatus::kCloseToGoal);

  EgoRequest bad = Ahead();
  bad.ends.v_end.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(plan.Run(grid, bad).status, EgoStatus::kInvalidInput);
  bad = Ahead();
  bad.ends.start.v.x() = 1e6;  // no sampling of the quintic is fine enough
  EXPECT_EQ(plan.Run(grid, bad).status, EgoStatus::kNoInitialPath);
  bad = Ahead();
  bad.ends.start.p = {-11, 0, 1};
  EXPECT_EQ(plan.Run(grid, bad).status, EgoStatus::kOutsideMap);

  // The start inside an obstacle.
  AddBox({-4.2, -0.2, 0}, {-3.8, 0.2, 3}, &grid);
  EXPECT_EQ(plan.Run(grid, Ahead()).status, EgoStatus::kStartInObstacle);

  // A wall across the whole map: no way around.
  CubeGrid walled = EmptyGrid();
  AddBox({-1.3, -10, 0}, {-1.0, 10, 3}, &walled);
  EXPECT_EQ(plan.Run(walled, Ahead()).status, EgoStatus::kSearchFailed);

  // All from the middle on is occupied: the blocked stretch reaches the end of the polygon.
  CubeGrid tail = EmptyGrid();
  AddBox({-1, -10, 0}, {10, 10, 3}, &tail);
  EgoRequest sideways = Ahead();  // else the first guess is left as it is, and nothing looks
  sideways.ends.start.v = {0, 1.5, 0};
  EXPECT_EQ(plan.Run(tail, sideways).status, EgoStatus::kTerminalBlocked);
}

TEST(EgoPlan, ReboundsAndRestartsEnd) {
  // A slot narrower than the clearance on both sides: pairs of both walls contradict each other.
  CubeGrid slot = EmptyGrid();
  AddBox({-2.2, -0.6, 0}, {-0.6, -0.1, 3}, &slot);
  AddBox({-2.2, 0.2, 0}, {-0.6, 0.8, 3}, &slot);
  EgoOptions options;
  options.max_rebounds = 0;
  options.max_restarts = 1;
  EgoPlan plan(options);
  bool restarts = false, rebounds = false;
  for (double y = -1.2; y <= 1.2; y += 0.05) {
    EgoRequest request = Ahead();
    request.ends.start.p.y() = y;
    request.ends.start.v = {1.2, -y, 0};
    const EgoStatus status = plan.Run(slot, request).status;
    restarts = restarts || status == EgoStatus::kRestartsUsedUp;
    rebounds = rebounds || status == EgoStatus::kReboundsUsedUp;
  }
  EXPECT_TRUE(restarts);
  EXPECT_TRUE(rebounds);
}

TEST(EgoPlan, ASlowedDownCurveThatHitsIsNoPlan) {
  // The curve that is slowed down swings wider than the one that was checked. It does so behind the
  // vehicle, where it turns round at twice the speed that it may fly.
  bool hit = false;
  EgoPlan plan({});
  for (double x = -6.5; x < -4.5 && !hit; x += 0.02) {
    CubeGrid grid = EmptyGrid();
    AddBox({x - 0.3, -1, 0}, {x, 1, 3}, &grid);
    EgoRequest request = Ahead();
    request.ends.start.v = {-2, 0, 0};
    hit = plan.Run(grid, request).status == EgoStatus::kRefinementHit;
  }
  EXPECT_TRUE(hit);
}

TEST(EgoPlan, EveryStatusHasANameAndASentence) {
  for (int i = 0; i <= static_cast<int>(EgoStatus::kRefinementHit); ++i) {
    const auto status = static_cast<EgoStatus>(i);
    EXPECT_STRNE(ToString(status), "unknown");
    EXPECT_STRNE(Explain(status), "Unknown.");
  }
}

TEST(EgoPlan, ATailInAnObstacleIsAcceptedAsPublished) {
  CubeGrid grid = EmptyGrid();
  AddBox({3.0, -0.5, 0}, {4.0, 0.5, 3}, &grid);
  EgoPlan plan({});
  EXPECT_EQ(plan.Run(grid, Ahead()).status, EgoStatus::kPlanned);
}

TEST(EgoPlan, TheSameCallsGiveTheSamePlans) {
  CubeGrid grid = EmptyGrid();
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> u(-3.0, 3.0);
  for (int i = 0; i < 12; ++i) {
    const double x = u(engine), y = u(engine);
    AddBox({x, y, 0}, {x + 0.4, y + 0.4, 3}, &grid);
  }
  const auto run = [&] {
    EgoPlan plan({}, 9);
    std::vector<EgoPlanResult> results;
    for (const EgoGuess guess : {EgoGuess::kPolynomial, EgoGuess::kRandom, EgoGuess::kRandom}) {
      EgoRequest request = Ahead();
      request.guess = guess;
      results.push_back(plan.Run(grid, request));
    }
    return results;
  };
  const auto once = run(), again = run();
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].status, again[i].status);
    EXPECT_EQ(once[i].counts.evaluations, again[i].counts.evaluations);
    EXPECT_EQ(once[i].curve.control_points(), again[i].curve.control_points());
  }
}

TEST(EgoPlan, RefusesOptionsOutOfRange) {
  EgoOptions options;
  options.max_speed = 0.0;
  EXPECT_THROW(EgoPlan{options}, std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
