// SPDX-License-Identifier: BSD-3-Clause
// Which arrival time a step tries: later if the way around is longer, and if the pad is out of
// reach behind an obstacle meanwhile.

#include <gtest/gtest.h>

#include "planning/problem/duration_guess.h"
#include "planning/test/replanner_fixtures.h"

namespace touchdown::planning {
namespace {

void AddWall(double x, double half_width, OccupancyMap* map) {
  for (double y = -half_width; y <= half_width; y += 0.1) {
    for (double z = 0.05; z < 3.1; z += 0.1) map->SetOccupied({x, y, z});
  }
}

double Guess(const ReplannerOptions& options, const ReplanInput& input, const SplineState& start) {
  return GuessDuration(start, input.t_start, *input.pad, input.endpoint, options.limits, 1.0);
}

TEST(ReplannerArrival, TheWiderAWallTheLaterThePlanArrives) {
  const ReplannerOptions options = Options(ArrivalMode::kFixed);
  const Eigen::Vector3d start(-4.0, 0.0, 1.6), v_WB(1.0, 0.0, 0.0);
  const ArcPad pad({4.0, 0.0, 0.3}, 0.2, 1.57, 0.0);
  double last = 0.0;
  for (const double half_width : {0.0, 1.0, 2.0, 3.0}) {
    OccupancyMap map = ObservedMap();
    if (half_width > 0.0) AddWall(0.05, half_width, &map);
    Replanner replanner(options, solvers::StandardBackends());
    FlyAlong(start, v_WB, &replanner);
    ReplanInput input = Input(start, pad, 0.0);
    input.vehicle.v_WB = v_WB;
    ReplanLog log;
    replanner.set_log(&log);
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned) << half_width;
    EXPECT_GT(result.curve.duration(), last) << half_width;
    last = result.curve.duration();
    // Already the first attempt accounts for the longer path.
    ASSERT_FALSE(log.attempts.empty());
    const double guess = Guess(
        options, input, {replanner.Reference(input.t_start).p_WB, v_WB, Eigen::Vector3d::Zero()});
    if (half_width > 0.0) {
      EXPECT_GT(log.attempts.front().duration, guess + 0.05) << half_width;
    } else {
      EXPECT_NEAR(log.attempts.front().duration, guess, 1e-9);
    }
  }
}

// Before, the fresh guess knew the straight way only and broke the promise: every step postponed
// the arrival.
TEST(ReplannerArrival, ALongWayRoundIsFlownToItsEnd) {
  for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
    OccupancyMap map = ObservedMap();
    AddWall(0.05, 3.5, &map);
    const ArcPad pad({1.5, 0.0, 0.3}, 0.0, 0.0, 0.0);
    Replanner replanner(Options(arrival), solvers::StandardBackends());
    const Eigen::Vector3d start(-1.5, 0.0, 1.6);
    FlyAlong(start, {0.0, 0.0, 0.0}, &replanner);
    double promised = 0.0;
    for (double t = 0.0; t < promised - 1.0 || t == 0.0; t += 0.1) {
      ReplanInput input = Input(replanner.Reference(t).p_WB, pad, t);
      input.vehicle.v_WB = replanner.Reference(t).v_WB;
      const ReplanResult& result = replanner.Replan(input, map);
      ASSERT_EQ(result.status, ReplanStatus::kPlanned) << t;
      if (t == 0.0) promised = result.curve.t_end();
      EXPECT_LT(result.curve.t_end(), 1.1 * promised) << t;
      promised = result.curve.t_end();
    }
  }
}

TEST(ReplannerArrival, APadThatPassesAnObstacleIsMetBehindIt) {
  for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
    // At the first guess the endpoint is in the pillar.
    const ReplannerOptions options = Options(arrival);
    const Eigen::Vector3d start(-4.0, 0.0, 1.6);
    const ArcPad pad({1.0, -3.0, 0.3}, 1.0, 1.5707963267948966, 0.0);
    ReplanInput input = Input(start, pad, 0.0);
    const double guess =
        Guess(options, input, {start, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
    OccupancyMap map = ObservedMap();
    const Eigen::Vector3d blocked = pad.At(input.t_start + guess).p_WP;
    AddPillar({blocked.x(), blocked.y()}, &map);
    Replanner replanner(options, solvers::StandardBackends());
    replanner.CommitHover(start, 0.0);
    ReplanLog log;
    replanner.set_log(&log);
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned);
    if (arrival == ArrivalMode::kFree) continue;  // it may move back to where the end is blocked
    // No attempt is spent on an end that is blocked, and it is met soon after that is over.
    for (const AttemptLog& attempt : log.attempts) {
      EXPECT_NE(attempt.reason, ReplanReason::kGoalBlocked);
    }
    EXPECT_GT(log.attempts.front().duration, guess);
    EXPECT_LT(log.attempts.front().duration, guess + 1.5);
  }
}

TEST(ReplannerArrival, AnEndThatStaysBlockedCostsNoSolve) {
  for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
    const Eigen::Vector3d start(-4.0, 0.0, 1.6);
    const ArcPad pad({1.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
    OccupancyMap map = ObservedMap();
    AddPillar({1.0, 0.0}, &map);
    Replanner replanner(Options(arrival), solvers::StandardBackends());
    replanner.CommitHover(start, 0.0);
    const ReplanResult& result = replanner.Replan(Input(start, pad, 0.0), map);
    EXPECT_EQ(result.reason, ReplanReason::kGoalBlocked);
    EXPECT_EQ(result.solves, 0);
  }
}

}  // namespace
}  // namespace touchdown::planning
