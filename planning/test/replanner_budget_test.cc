// SPDX-License-Identifier: BSD-3-Clause
// A step does no more work than its budget, and the next one goes on where it ended.

#include <gtest/gtest.h>

#include "planning/search/work_budget.h"
#include "planning/test/replanner_fixtures.h"

namespace touchdown::planning {
namespace {

constexpr int kFew = 4500 / WorkBudget::kAtRest;  // for such walls, in one step

/// Walls with a door each, which take several rounds and arrivals to get through.
OccupancyMap WallsWithDoors(Draw* draw) {
  OccupancyMap map = ObservedMap();
  for (const double x : {-2.45, 0.05, 2.55}) {
    const double door = draw->Uniform(-3.0, 3.0);
    for (double y = -6.0; y < 6.0; y += 0.1) {
      if (std::abs(y - door) < 0.5) continue;
      for (double z = 0.05; z < 4.0; z += 0.1) map.SetOccupied({x, y, z});
    }
  }
  return map;
}

ReplannerOptions Within(int work, ArrivalMode arrival = ArrivalMode::kFree) {
  ReplannerOptions options = Options(arrival);
  options.max_work = work;
  options.ceiling_height = 3.0;
  // Searches take only a part of the work: this test is about how attempts continue.
  options.constants.heuristic_weight = 6.0;
  return options;
}

TEST(ReplannerBudget, CountsTheSegmentsOfAStepThatSolvesOnce) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.5, 0.3}, 0.0, 0.0, 0.0);
  const Eigen::Vector3d start(-5.0, 0.0, 1.6);
  Replanner replanner(Within(10000), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  const ReplanResult& result = replanner.Replan(Input(start, pad, 0.0), map);
  ASSERT_EQ(result.status, ReplanStatus::kPlanned);
  ASSERT_EQ(result.solves, 1);
  const int evaluations = result.solver.evaluations + WorkBudget::kEvaluationsOfSetUp;
  EXPECT_EQ(result.work, WorkBudget::kSegment * result.curve.segments() * evaluations);
}

/// The work of a log's solves: each of its curve's segments and its pairs.
int WorkOfSolves(const ReplanLog& log) {
  int work = 0;
  for (const AttemptLog& attempt : log.attempts) {
    for (const RoundLog& round : attempt.rounds) {
      if (!round.solver.usable()) continue;  // it has no curve
      const int evaluations = round.solver.evaluations + WorkBudget::kEvaluationsOfSetUp;
      work += WorkBudget::kSegment * round.curve.segments() * evaluations +
              WorkBudget::kPair * static_cast<int>(round.pairs.size());
    }
  }
  return work;
}

TEST(ReplannerBudget, IsNeverExceeded) {
  Draw draw(61);
  int spent = 0, searched = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const OccupancyMap map = WallsWithDoors(&draw);
    const ArcPad pad{{5.0, draw.Uniform(-1, 1), 0.3}, 0.3, draw.Uniform(-3, 3), 0.0};
    const ReplannerOptions options = Within(static_cast<int>(draw.Uniform(100, 4000)));
    Replanner replanner(options, solvers::StandardBackends());
    const Eigen::Vector3d start(-5.0, 0.0, 1.6), v_WB(1.5, 0.0, 0.0);
    FlyAlong(start, v_WB, &replanner);
    ReplanLog log;
    replanner.set_log(&log);
    for (double t = 0.0; t < 0.75; t += 0.1) {
      ReplanInput input = Input(replanner.Reference(t).p_WB, pad, t);
      input.vehicle.v_WB = replanner.Reference(t).v_WB;
      const bool rests = replanner.Reference(input.t_start).v_WB.norm() < 0.05;
      const ReplanResult& result = replanner.Replan(input, map);
      EXPECT_LE(result.work, (rests ? WorkBudget::kAtRest : 1) * options.max_work) << trial;
      EXPECT_GE(result.work, WorkOfSolves(log)) << trial;
      searched += result.work > WorkOfSolves(log);
      spent += replanner.state().unfinished.has_value();
    }
  }
  EXPECT_GT(spent, 5);
  EXPECT_GT(searched, 5);
}

TEST(ReplannerBudget, IsLargerForAVehicleThatRests) {
  Draw draw(61);
  int larger = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const OccupancyMap map = WallsWithDoors(&draw);
    const ArcPad pad({5.0, draw.Uniform(-1, 1), 0.3}, 0.0, 0.0, 0.0);
    const Eigen::Vector3d start(-5.0, 0.0, 1.6);
    const ReplannerOptions options = Within(1000);
    Replanner replanner(options, solvers::StandardBackends());
    replanner.CommitHover(start, 0.0);
    const int work = replanner.Replan(Input(start, pad, 0.0), map).work;
    EXPECT_LE(work, WorkBudget::kAtRest * options.max_work);
    larger += work > options.max_work;
  }
  EXPECT_GT(larger, 10);
}

class ReplannerBudgets : public ::testing::TestWithParam<ArrivalMode> {};
INSTANTIATE_TEST_SUITE_P(Arrivals, ReplannerBudgets,
                         ::testing::Values(ArrivalMode::kFixed, ArrivalMode::kFree));

// From rest, where nothing changes, small steps find the same as a large one.
TEST_P(ReplannerBudgets, SmallStepsFindWhatALargeOneFinds) {
  Draw draw(62);
  int large_found = 0, small_found = 0, at_once = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const OccupancyMap map = WallsWithDoors(&draw);
    const ArcPad pad({5.0, draw.Uniform(-1, 1), 0.3}, 0.0, 0.0, 0.0);
    const Eigen::Vector3d start(-5.0, 0.0, 1.6);
    Replanner large(Within(10000000, GetParam()), solvers::StandardBackends());
    large.CommitHover(start, 0.0);
    const bool found = large.Replan(Input(start, pad, 0.0), map).status == ReplanStatus::kPlanned;
    large_found += found;
    Replanner small(Within(kFew, GetParam()), solvers::StandardBackends());
    small.CommitHover(start, 0.0);
    for (int step = 0; step < 30; ++step) {
      const ReplanResult& result = small.Replan(Input(start, pad, 0.1 * step), map);
      if (result.status != ReplanStatus::kPlanned) continue;
      ++small_found;
      at_once += step == 0;
      break;
    }
  }
  EXPECT_GT(large_found, 20);
  EXPECT_LT(at_once, small_found - 2);
  EXPECT_GE(small_found, large_found - 1);
}

TEST(ReplannerBudget, TheNextStepFollowsFromTheState) {
  Draw draw(63);
  int unfinished = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const OccupancyMap map = WallsWithDoors(&draw);
    const ArcPad pad({5.0, draw.Uniform(-1, 1), 0.3}, 0.0, 0.0, 0.0);
    const Eigen::Vector3d start(-5.0, 0.0, 1.6);
    Replanner flown(Within(kFew), solvers::StandardBackends());
    Replanner other(Within(kFew), solvers::StandardBackends());
    flown.CommitHover(start, 0.0);
    for (int step = 0; step < 6; ++step) {
      const ReplanInput input = Input(start, pad, 0.1 * step);
      const ReplannerState before = flown.state();
      unfinished += before.unfinished.has_value();
      const ReplanResult& wanted = flown.Replan(input, map);
      other.Restore(before);
      const ReplanResult& got = other.Replan(input, map);
      ASSERT_EQ(got.reason, wanted.reason) << step;
      ASSERT_EQ(got.solves, wanted.solves) << step;
      ASSERT_EQ(got.work, wanted.work) << step;
      ASSERT_EQ(got.curve.control_points(), wanted.curve.control_points()) << step;
      if (wanted.status == ReplanStatus::kPlanned) break;
    }
  }
  EXPECT_GT(unfinished, 10);
}

}  // namespace
}  // namespace touchdown::planning
