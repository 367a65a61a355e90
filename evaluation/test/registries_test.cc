// SPDX-License-Identifier: BSD-3-Clause
// Faulty entries end in a sentence, and right ones can be used.
#include "touchdown/evaluation/scenario/registries.h"

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/record/replay.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;

/// The shipped ones and a planner that `spoil` has changed.
std::string Refusal(void (*spoil)(PlannerEntry* entry)) {
  Registries registries = StandardRegistries();
  PlannerEntry entry = registries.planners.front();
  entry.name = "mine";
  Parameter share;
  share.key = "mine.share";
  share.value = 0.5;
  share.range.hi = 1.0;
  share.doc = "of something";
  entry.parameters = {share};
  spoil(&entry);
  registries.planners.push_back(entry);
  try {
    RequireDistinct(registries);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

struct Slip {
  void (*make)(PlannerEntry* entry);
  const char* said;
};

TEST(Registries, WhatAnEntrySaysWrongIsNamed) {
  const Slip slips[] = {
      {[](PlannerEntry*) {}, "accepted"},
      {[](PlannerEntry* e) { e->name = "ego"; }, "two of the planner ego"},
      {[](PlannerEntry* e) { e->name = "my planner"; }, "my planner"},
      {[](PlannerEntry* e) { e->name = ""; }, "its name"},
      {[](PlannerEntry* e) { e->make = nullptr; }, "make"},
      {[](PlannerEntry* e) { e->rate = -1.0; }, "rate is -1"},
      {[](PlannerEntry* e) { e->rate = std::nan(""); }, "rate"},
      {[](PlannerEntry* e) { e->parameters[0].key = "share"; }, "GROUP.NAME"},
      {[](PlannerEntry* e) { e->parameters[0].key = "mine..share"; }, "GROUP.NAME"},
      {[](PlannerEntry* e) { e->parameters[0].key = "mine.the share"; }, "letters"},
      {[](PlannerEntry* e) { e->parameters[0].key = "pad.speed"; }, "already"},
      {[](PlannerEntry* e) { e->parameters[0].key = "planner.share"; }, "already"},
      {[](PlannerEntry* e) { e->parameters[0].key = "solver.options.share"; }, "group of others"},
      {[](PlannerEntry* e) { e->parameters[0].key = "obstacles.boxes"; }, "group of others"},
      {[](PlannerEntry* e) { e->parameters[0].key = "ego.horizon"; }, "another default or range"},
      {[](PlannerEntry* e) { e->parameters[0].value = 50.0; },
       "default 50, which is not in [0, 1]"},
      {[](PlannerEntry* e) { e->parameters[0].value = std::nan(""); }, "default nan"},
      {[](PlannerEntry* e) {
         e->parameters.push_back(e->parameters[0]);
         e->parameters[1].key = "mine.share.of";
       },
       "is the group of mine.share.of"},
  };
  for (const Slip& slip : slips) EXPECT_THAT(Refusal(slip.make), HasSubstr(slip.said));
}

TEST(Registries, NothingThatIsMadeIsSaidSo) {
  Registries registries = StandardRegistries();
  for (PlannerEntry& entry : registries.planners) {
    entry.make = [](const PlannerSetup&) { return nullptr; };
  }
  for (PadMotionEntry& entry : registries.pad_motions) {
    entry.make = [](const PadMotionSetup&) { return nullptr; };
  }
  for (PredictorEntry& entry : registries.predictors) {
    entry.make = [](const PredictorSetup&) { return nullptr; };
  }
  const auto said = [](auto&& call) {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const Scenario scenario;
  EXPECT_EQ(said([&] { MakePlanner(scenario, {}, registries); }),
            "the planner landing made nothing");
  EXPECT_EQ(said([&] { PadCourseOf(scenario, registries, 0.0, 1); }),
            "the pad motion straight_turn made nothing");
  EXPECT_EQ(said([&] { PredictorOf(scenario, registries, nullptr); }),
            "the pad predictor turn_rate made nothing");
  registries.planners.clear();
  EXPECT_EQ(said([&] { PlannerOf(scenario, registries); }), "there is no planner landing");
}

}  // namespace
}  // namespace touchdown::evaluation
