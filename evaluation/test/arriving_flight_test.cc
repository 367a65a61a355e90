// SPDX-License-Identifier: BSD-3-Clause
// Flights that would stand still without going to look (docs/liveness.md).
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/flight/closed_loop.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;

constexpr const char* kOverPad =
    "{pad: {motion: static, start: [0, 0]}, start: {position: [0, 0, 3]}, timeout: 30";

TrialResult Fly(const std::string& yaml, std::uint64_t seed, TrialRecord* record = nullptr) {
  const Scenario scenario = ParseScenario(yaml, "world", "world", {}, StandardRegistries());
  return RunTrial(scenario, seed, StandardRegistries(), record);
}

// 5 of 20 landed within 60 s before there were looks.
TEST(ArrivingFlight, OverAPadThatStands) {
  int looked = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    TrialRecord record;
    const TrialResult result = Fly(std::string(kOverPad) + "}", seed, &record);
    ASSERT_TRUE(result.landed()) << result.detail;
    EXPECT_LT(result.touchdown->t, 15.0);
    EXPECT_EQ(result.safety->uncertified_steps, 0);
    looked += std::any_of(record.plans.begin(), record.plans.end(), [](const auto& plan) {
      return plan.request.input.look_from_W.has_value();
    });
  }
  EXPECT_GE(looked, 2);
}

TEST(ArrivingFlight, ACameraThatLooksDownSavesTheLook) {
  const TrialResult result =
      Fly(std::string(kOverPad) +
              ", depth: {cameras: [{}, {position: [0, 0, -0.05], pitch_deg: 90, rate: 20}]}}",
          1);
  ASSERT_TRUE(result.landed()) << result.detail;
  EXPECT_LT(result.touchdown->t, 3.0);
  EXPECT_EQ(result.safety->uncertified_steps, 0);
}

// 40 m deep, up to the ceiling: the vehicle came back to its bottom for ever, and claimed no_way there.
TEST(ArrivingFlight, OutOfADeadEndLargerThanTheWindow) {
  TrialRecord record;
  const TrialResult result =
      Fly("{pad: {motion: static, start: [30, 0]}, start: {position: [-14, 0, 1.5]}, timeout: 150, "
          "planning: {ceiling: 4}, obstacles: {boxes: [{centre: [20, 0], size: [0.3, 12, 5]}, "
          "{centre: [0, 6], size: [40, 0.3, 5]}, {centre: [0, -6], size: [40, 0.3, 5]}]}}",
          1, &record);
  ASSERT_TRUE(result.landed()) << result.detail;
  EXPECT_EQ(result.safety->uncertified_steps, 0);
  const bool claimed = std::any_of(record.events.begin(), record.events.end(),
                                   [](const auto& event) { return event.kind == "no_way"; });
  EXPECT_FALSE(claimed);
}

// The pad in a closed box, on whose roof the vehicle could wait for ever.
TEST(ArrivingFlight, AClosedCageAroundThePadIsNoWay) {
  const TrialResult result =
      Fly("{pad: {motion: static, start: [8, 0]}, start: {position: [0, 0, 1.5]}, timeout: 60, "
          "obstacles: {boxes: [{centre: [8, 0], size: [4, 4, 0.2], base: 2.5}, "
          "{centre: [10, 0], size: [0.2, 4, 2.5]}, {centre: [6, 0], size: [0.2, 4, 2.5]}, "
          "{centre: [8, 2], size: [4, 0.2, 2.5]}, {centre: [8, -2], size: [4, 0.2, 2.5]}]}}",
          1);
  EXPECT_FALSE(result.landed());
  ASSERT_TRUE(result.no_way) << result.detail;
  EXPECT_GT(result.no_way->looks, 0);
}

// A room around the start with a gap of a metre, less than a plan passes.
TEST(ArrivingFlight, ARoomWithADoorThatIsTooNarrowIsNoWay) {
  TrialRecord record;
  const TrialResult result = Fly(
      "{pad: {motion: static, start: [9, 0]}, start: {position: [0, 0, 1.5]}, "
      "planning: {ceiling: 4}, timeout: 40, obstacles: {boxes: ["
      "{centre: [4, 2.3], size: [0.3, 3.6, 4.5]}, {centre: [4, -2.3], size: [0.3, 3.6, 4.5]}, "
      "{centre: [-4, 0], size: [0.3, 8.3, 4.5]}, {centre: [0, 4], size: [8.3, 0.3, 4.5]}, "
      "{centre: [0, -4], size: [8.3, 0.3, 4.5]}]}}",
      1, &record);
  EXPECT_FALSE(result.succeeded());
  EXPECT_EQ(result.safety->uncertified_steps, 0);
  ASSERT_TRUE(result.no_way) << result.detail;
  EXPECT_GE(result.no_way->looks, 1);
  ASSERT_TRUE(result.no_way->narrowest);
  EXPECT_NEAR(result.no_way->narrowest->p_W.x(), 4.0, 0.4);
  EXPECT_NEAR(result.no_way->narrowest->p_W.y(), 0.0, 0.2);
  EXPECT_NEAR(result.no_way->narrowest->width, 1.0, 0.31);  // edges, and noise
  EXPECT_GT(result.no_way->needed_m, result.no_way->narrowest->width);
  EXPECT_THAT(result.detail, HasSubstr("the vehicle knew no way"));
  const bool noted = std::any_of(record.events.begin(), record.events.end(), [](const auto& event) {
    return event.kind == "no_way" && event.text.find("seen cells are needed") != std::string::npos;
  });
  EXPECT_TRUE(noted);
}

}  // namespace
}  // namespace touchdown::evaluation
