// SPDX-License-Identifier: BSD-3-Clause
// Whole flights of the PID baseline, of the paper's Figure 4, and with parts of the planner switched off.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/record.h"
#include "evaluation/record/replay.h"
#include "evaluation/record/trial_json.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using Overrides = std::vector<std::string>;

Scenario Shipped(const std::string& name, Overrides overrides) {
  return LoadScenario(FindScenario(name), overrides, StandardRegistries());
}

TrialResult Fly(const std::string& name, const Overrides& overrides, std::uint64_t seed) {
  return RunTrial(Shipped(name, overrides), seed, StandardRegistries());
}

TEST(BaselineFlight, PidLandsInTheOpen) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TrialResult result =
        Fly("open", {"planner=pid", "start.position_spread=[2, 2, 0.3]"}, seed);
    ASSERT_EQ(result.outcome, Outcome::kLanded) << result.detail;
    EXPECT_LT(result.touchdown->error_m, 0.1);
    EXPECT_EQ(result.replans_by_status.size(), 1u) << "every step is a plan";
  }
}

TEST(BaselineFlight, PidLandsInWind) {
  const TrialResult result = Fly("open", {"planner=pid", "wind.mean=7", "wind.max=11"}, 1);
  EXPECT_EQ(result.outcome, Outcome::kLanded) << result.detail;
}

TEST(BaselineFlight, PidHasNoPlanToContactAndNoBackend) {
  EXPECT_EQ(Shipped("open", {"planner=pid"}).descent, DescentKind::kVertical);
  try {
    Shipped("open", {"planner=pid", "descent=planned"});
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("descent must be vertical with planner pid"));
  }
  EXPECT_THROW(Shipped("open", {"planner=pid", "pid.response=0"}), BadInput);
  const Scenario scenario = Shipped("open", {"planner=pid", "timeout=1"});
  const TrialResult result = RunTrial(scenario, 1, StandardRegistries());
  EXPECT_EQ(LandJson(scenario, result)["planner"], "pid");
  EXPECT_EQ(LandJson(scenario, result)["backend"], "none");
}

// It answers whenever it is asked: all its steps are recorded, and asked again from the first on.
TEST(BaselineFlight, APidRecordKeepsTheLimitsAndItsStepsAreAskedAgain) {
  const std::string path = ::testing::TempDir() + "touchdown_pid_record.db";
  const Scenario scenario = Shipped("open", {"planner=pid", "timeout=4"});
  const Registries registries = StandardRegistries();
  TrialRecord record;
  const TrialResult result = RunTrial(scenario, scenario.seed, registries, &record);
  WriteRecord(path, scenario, result, record);
  for (const RecordSample& sample : record.samples) {
    EXPECT_LE(sample.reference.v_WB.norm(), scenario.limits.speed + 1e-9);
    EXPECT_LE(sample.reference.a_WB.norm(), scenario.limits.acceleration + 1e-9);
  }
  const RecordedFlight flight = ReadRecord(path, {}, registries);
  EXPECT_EQ(static_cast<int>(flight.plans.size()), result.replans);
  ASSERT_GT(flight.plans.size(), 50u);
  EXPECT_EQ(flight.plans.back().result.curve.segments(), 1);
  Replay replay(flight, registries);
  for (const int step : {0, 1, 20, 20, 5, replay.steps() - 1}) {
    replay.Seek(step);
    EXPECT_TRUE(Same(OutcomeOf(replay.Solve()), replay.recorded().result)) << step;
    EXPECT_TRUE(Same(OutcomeOf(replay.Solve()), replay.recorded().result)) << step << ", again";
  }
  std::filesystem::remove(path);
}

// The paper's Figure 4: the baseline follows about half a metre behind and does not land.
TEST(BaselineFlight, Figure4) {
  const Overrides two_goals = {"planner=ego", "ego.goal_rate=2"};
  Overrides following = two_goals;
  following.push_back("task=follow");
  following.push_back("follow.time=0");
  const TrialResult follows = Fly("figure4", following, 1);
  ASSERT_TRUE(follows.following);
  EXPECT_GT(follows.following->mean_error_m, 0.4);
  EXPECT_LT(follows.following->mean_error_m, 0.6);
  EXPECT_FALSE(Fly("figure4", two_goals, 1).landed());
  EXPECT_EQ(Fly("figure4", {}, 1).outcome, Outcome::kLanded);
}

TEST(BaselineFlight, WithPartsOfThePlannerSwitchedOff) {
  const TrialResult cold = Fly("straight_turn", {"planning.warm_start=false"}, 1);
  EXPECT_EQ(cold.outcome, Outcome::kLanded) << cold.detail;
  const TrialResult rest = Fly("open", {"planning.endpoint_velocity=rest", "descent=vertical"}, 1);
  const TrialResult whole = Fly("open", {"descent=vertical"}, 1);
  ASSERT_EQ(whole.outcome, Outcome::kLanded);
  // It plans to the predicted pad, and the vehicle waits there. The study has more figures.
  EXPECT_GT(rest.replans_by_status.at("planned"), 20);
  EXPECT_NE(rest.simulated_s, whole.simulated_s);
}

TEST(BaselineFlight, MeasuredLatencyLandsToo) {
  const TrialResult result = Fly("open", {"planning.latency=measured"}, 1);
  EXPECT_EQ(result.outcome, Outcome::kLanded) << result.detail;
}

}  // namespace
}  // namespace touchdown::evaluation
