// SPDX-License-Identifier: BSD-3-Clause
// Whole landings by one plan to contact: soft, soon, in wind; and pads that no vehicle can land on.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/flight/closed_loop.h"
#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {
namespace {

Scenario Shipped(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return LoadScenario(FindScenario(name), overrides, StandardRegistries());
}

double Horizontal(const Touchdown& touchdown) {
  return touchdown.relative_velocity.head<2>().norm();
}

bool TouchedAnything(const TrialResult& result) {
  return result.touchdown.has_value() || result.detail.find("Touched") != std::string::npos;
}

TEST(PlannedLanding, IsTheDefaultSoftAndSoonerThanTheVerticalOne) {
  for (const char* name : {"open", "straight_turn", "circle", "forest"}) {
    const TrialResult planned = RunTrial(Shipped(name), 3, StandardRegistries());
    const TrialResult vertical =
        RunTrial(Shipped(name, {"descent=vertical"}), 3, StandardRegistries());
    ASSERT_EQ(planned.outcome, Outcome::kLanded) << name << planned.detail;
    ASSERT_EQ(vertical.outcome, Outcome::kLanded) << name << vertical.detail;
    EXPECT_LT(planned.touchdown->t, 0.75 * vertical.touchdown->t) << name;
    EXPECT_LT(planned.touchdown->error_m, 0.05) << name;
    EXPECT_LT(Horizontal(*planned.touchdown), 0.2) << name;
    EXPECT_LT(std::abs(planned.touchdown->relative_velocity.z()), 0.4) << name;
  }
}

TEST(PlannedLanding, PlansAtTwentyHertzBeforeContact) {
  TrialRecord record;
  const TrialResult result = RunTrial(Shipped("open"), 3, StandardRegistries(), &record);
  ASSERT_EQ(result.outcome, Outcome::kLanded);
  int close = 0;
  for (const RecordPlan& plan : record.plans) {
    const double before = result.touchdown->t - plan.request.input.t_now;
    if (before > 0.0 && before < 1.0) ++close;
  }
  EXPECT_GE(close, 20);
}

double LowestFeet(const TrialRecord& record, const estimation::VehicleModel& model) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const RecordSample& sample : record.samples) {
    const double height = sample.vehicle.p_WB.z() - model.foot_depth - sample.pad.p_WP.z();
    lowest = std::min(lowest, height);
  }
  return lowest;
}

// A vehicle that has not seen the tags turns away above the deck, by certified plans.
TEST(PlannedLanding, WithoutTagsItStaysAboveThePadHoweverSeldomItPlans) {
  const std::vector<std::vector<std::string>> cases = {
      {}, {"planning.rate=5"}, {"planning.latency=90"}, {"planning.rate=1"}};
  for (std::vector<std::string> overrides : cases) {
    overrides.insert(overrides.end(), {"tags.rate=0.01", "timeout=10"});
    TrialRecord record;
    const TrialResult result =
        RunTrial(Shipped("open", overrides), 1, StandardRegistries(), &record);
    EXPECT_EQ(result.outcome, Outcome::kTimeout) << overrides.front() << result.detail;
    EXPECT_EQ(result.replans_by_status.count("unsafe"), 0u) << overrides.front();
    EXPECT_GT(LowestFeet(record, estimation::VehicleModel{}), 0.8) << overrides.front();
  }
}

TEST(PlannedLanding, AFastPadIsNotTouchedBlindEither) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    TrialRecord record;
    const TrialResult result = RunTrial(Shipped("open_fast", {"tags.rate=0.01", "timeout=10"}),
                                        seed, StandardRegistries(), &record);
    EXPECT_EQ(result.outcome, Outcome::kTimeout) << seed << result.detail;
    EXPECT_GT(LowestFeet(record, estimation::VehicleModel{}), 0.8) << seed;
  }
}

// Every latency, on the simulation's clock or off it.
TEST(PlannedLanding, CloseStepsAreNotAskedForBeforeThePlanBeforeIsFlown) {
  for (const char* latency : {"50", "55", "65", "75", "95"}) {
    const TrialResult result = RunTrial(
        Shipped("open", {std::string("planning.latency=") + latency}), 1, StandardRegistries());
    EXPECT_EQ(result.outcome, Outcome::kLanded) << latency;
    const auto early = result.replans_by_reason.find("invalid_input");
    const int refused = early == result.replans_by_reason.end() ? 0 : early->second;
    EXPECT_EQ(refused, 0) << latency << " ms";
  }
}

TEST(PlannedLanding, InAStrongWindToo) {
  const Scenario scenario = Shipped("straight_turn", {"wind.mean=11", "wind.max=15"});
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const TrialResult result = RunTrial(scenario, seed, StandardRegistries());
    EXPECT_EQ(result.outcome, Outcome::kLanded) << seed << result.detail;
  }
}

TEST(PlannedLanding, APadThatDrivesIntoATunnelIsNotFollowedThere) {
  const Scenario scenario = Shipped("tunnel");
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TrialResult result = RunTrial(scenario, seed, StandardRegistries());
    EXPECT_NE(result.outcome, Outcome::kLanded);
    EXPECT_FALSE(TouchedAnything(result)) << result.detail;
    EXPECT_GT(*result.min_clearance_m, 0.1);
  }
}

TEST(PlannedLanding, APadThatIsFasterThanTheVehicleIsLetGo) {
  const Scenario scenario =
      Shipped("open", {"pad.motion=line", "pad.speed=4", "pad.start=[2, 1]", "timeout=15"});
  TrialRecord record;
  const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
  EXPECT_EQ(result.outcome, Outcome::kInfeasible);
  EXPECT_FALSE(TouchedAnything(result)) << result.detail;
  const estimation::VehicleState& last = record.samples.back().vehicle;
  EXPECT_LT(last.v_WB.norm(), 0.2) << "it holds";
}

}  // namespace
}  // namespace touchdown::evaluation
