// SPDX-License-Identifier: BSD-3-Clause
// Flights with another task than landing. They end when the task is done, and not before.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/scenario/scenario_world.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;

Scenario Shipped(const std::string& name, const std::vector<std::string>& overrides) {
  return LoadScenario(FindScenario(name), overrides, StandardRegistries());
}

// The baseline learns of a moving goal only now and then, and never gets near it.
TEST(TaskFlight, AGoalIsReachedStandingAndMoving) {
  constexpr const char* kStands = "go_to.velocity=[0,0,0]";
  for (const char* velocity : {kStands, "go_to.velocity=[0.4,-0.3,0.05]"}) {
    for (const char* planner : {"planner=landing", "planner=ego"}) {
      if (planner == std::string("planner=ego") && velocity != std::string(kStands)) continue;
      const Scenario scenario =
          Shipped("open", {"task=go_to", "go_to.goal=[5,2,1.2]", velocity, planner});
      TrialRecord record;
      const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
      ASSERT_EQ(result.outcome, Outcome::kArrived) << planner << ": " << result.detail;
      EXPECT_TRUE(result.succeeded());
      EXPECT_FALSE(result.t_star_s || result.following || result.touchdown);
      // It was there for the requested second, and then the flight ended.
      const planning::MovingGoal goal = GoalOf(scenario);
      for (const RecordSample& sample : record.samples) {
        const double off = (sample.vehicle.p_WB - goal.At(sample.t).p_WP).norm();
        const double left = result.simulated_s - sample.t;
        if (left >= 1.0) continue;
        EXPECT_LE(off, scenario.go_to.distance + 1e-9) << sample.t;
      }
    }
  }
}

TEST(TaskFlight, AGoalAmongObstaclesIsReachedWithoutTouchingOne) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const TrialResult result = RunTrial(Shipped("goal", {}), seed, StandardRegistries());
    EXPECT_EQ(result.outcome, Outcome::kArrived) << seed << ": " << result.detail;
    EXPECT_EQ(result.safety->uncertified_steps, 0);
  }
}

TEST(TaskFlight, AGoalThatFliesAwayIsNotReached) {
  const Scenario scenario = Shipped("open", {"task=go_to", "go_to.velocity=[6,0,0]", "timeout=8"});
  const TrialResult result = RunTrial(scenario, 1, StandardRegistries());
  EXPECT_EQ(result.outcome, Outcome::kInfeasible);
  EXPECT_FALSE(result.succeeded());
}

TEST(TaskFlight, FollowingEndsWhenItIsDone) {
  const Scenario scenario = Shipped("open", {"task=follow", "follow.time=4"});
  TrialRecord record;
  const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
  ASSERT_EQ(result.outcome, Outcome::kFollowed) << result.detail;
  EXPECT_LT(result.simulated_s, 20.0);
  for (const RecordSample& sample : record.samples) {
    if (sample.t < result.simulated_s - 4.0) continue;
    EXPECT_LE((sample.vehicle.p_WB - sample.pad.p_WP).head<2>().norm(), 0.5) << sample.t;
  }
}

// Where a goal would be by default, too: a landing has none.
TEST(TaskFlight, ALandingThatStandsHasNoGoalToStandAt) {
  const Scenario scenario = Shipped("open", {"start.position=[6,0,2]", "pad.speed=10",
                                             "pad.start=[20,0]", "stand_limit=3", "timeout=20"});
  EXPECT_EQ(RunTrial(scenario, 1, StandardRegistries()).outcome, Outcome::kStood);
}

TEST(TaskFlight, WhoIsNeverNearEnoughDoesNotFollow) {
  const Scenario scenario = Shipped("open", {"task=follow", "planner=ego", "ego.goal_rate=1",
                                             "follow.distance=0.2", "timeout=20"});
  EXPECT_EQ(RunTrial(scenario, 1, StandardRegistries()).outcome, Outcome::kTimeout);
}

TEST(TaskFlight, AGoalThatCannotBeReachedIsRefused) {
  const auto refusal = [](const std::string& goal) {
    try {
      Shipped("straight_turn", {"task=go_to", "go_to.goal=" + goal});
    } catch (const BadInput& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal("[8,3,1.2]"), HasSubstr("obstacles.boxes[1], and is at -"));
  EXPECT_THAT(refusal("[8,0,0.2]"), HasSubstr("from the floor of plans to planning.ceiling"));
  EXPECT_THAT(refusal("[8,0,12]"), HasSubstr("not '12'"));
  EXPECT_EQ(refusal("[8,0,1.2]"), "accepted");
}

}  // namespace
}  // namespace touchdown::evaluation
