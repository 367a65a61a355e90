// SPDX-License-Identifier: BSD-3-Clause
// The same steps, and the same problems, for every backend.
#include "evaluation/profile/profile_backends.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/record.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class BackendsOfARecord : public ::testing::Test {
 protected:
  BackendsOfARecord() {
    const Scenario scenario =
        LoadScenario(FindScenario("forest"), {"timeout=2", "solver.gap=0.01"}, registries_);
    TrialRecord flown;
    const TrialResult result = RunTrial(scenario, scenario.seed, registries_, &flown);
    steps_ = static_cast<int>(flown.plans.size());
    for (const RecordPlan& plan : flown.plans) solves_ += plan.result.solves;
    WriteRecord(path_, scenario, result, flown);
  }
  ~BackendsOfARecord() override { std::filesystem::remove(path_); }

  const Registries registries_ = StandardRegistries();
  const std::string path_ = ::testing::TempDir() + "backends.db";
  int steps_ = 0, solves_ = 0;
};

TEST_F(BackendsOfARecord, AreMeasuredOnTheSameSolvesAndSteps) {
  BackendsOptions options;
  options.record = path_;
  options.backends = {"banded", "lbfgs"};
  options.repeats = 2;
  std::vector<std::string> told;
  const BackendsProfile profile =
      ProfileBackends(options, registries_, [&](const char* things, int done, int all) {
        if (told.empty() || told.back() != things) told.emplace_back(things);
        EXPECT_TRUE(all == 0 || done <= all);
      });
  EXPECT_THAT(told, ElementsAre("problems", "backends"));
  EXPECT_EQ(profile.gap, 0.01) << "the record's";
  EXPECT_EQ(static_cast<int>(profile.solves.problems.size()), solves_);
  ASSERT_EQ(profile.backends.size(), 2U);
  const int timed = TimedProblems(profile.solves);
  EXPECT_GT(timed, 0);
  for (const BackendLatency& of : profile.backends) {
    EXPECT_EQ(of.solves.problems, timed);
    EXPECT_EQ(of.solves.solved, timed) << of.solves.backend;
    EXPECT_GT(*of.step_ms.median, 0.0);
    EXPECT_LE(*of.step_ms.median, *of.step_ms.max);
    EXPECT_GT(of.plans, 0);
  }
  const std::string text = BackendsText(profile);
  EXPECT_THAT(text, HasSubstr("limits: soft"));
  EXPECT_THAT(text, HasSubstr("plans: steps that made a new plan"));
  EXPECT_THAT(text, HasSubstr("within 0.01 of the best known cost"));
  const nlohmann::ordered_json json = BackendsJson(profile, {});
  EXPECT_EQ(json["backends"]["lbfgs"]["solve"]["problems"], timed);
  EXPECT_GT(json["backends"]["lbfgs"]["step"]["median_ms"], 0.0);
}

TEST_F(BackendsOfARecord, KeepToWhatCanBeChanged) {
  BackendsOptions options;
  options.record = path_;
  options.overrides = {"limits.speed=2"};
  const BackendsProgress quiet = [](const char*, int, int) {};
  EXPECT_THROW(ProfileBackends(options, registries_, quiet), BadInput);
  options.overrides = {"solver.limits=hard"};
  options.backends = {"lbfgs"};
  EXPECT_THROW(ProfileBackends(options, registries_, quiet), BadInput);
}

}  // namespace
}  // namespace touchdown::evaluation
