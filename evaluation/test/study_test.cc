// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/study_plan.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/campaign/sweep.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

const Registries kRegistries = StandardRegistries();

StudyPlan Shipped(const std::string& name, bool quick) {
  const StudyFile file = LoadStudyFile(FindStudyFile(name), kRegistries);
  return PlanStudy(file, {.quick = quick}, file.seed, kRegistries);
}

/// Trials of each method in each cell.
std::map<std::pair<std::string, std::string>, int> Counts(const StudyPlan& plan) {
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const SweepTrial& trial : plan.campaign.trials) {
    ++counts[{trial.varied.at(0).second, trial.varied.at(1).second}];
  }
  return counts;
}

class ShippedStudy : public testing::TestWithParam<std::string> {};

// Common random numbers: trial i of every method in every cell has the same seed.
TEST_P(ShippedStudy, EveryScenarioLoadsAndSeedsArePaired) {
  const StudyPlan plan = Shipped(GetParam(), true);
  std::map<std::pair<std::string, std::string>, std::vector<std::uint64_t>> seeds;
  int index = 0;
  for (const SweepTrial& trial : plan.campaign.trials) {
    EXPECT_EQ(trial.index, index++);
    EXPECT_EQ(trial.scenario.timeout, 30.0);
    const bool lands = trial.scenario.task == TaskKind::kLand;
    EXPECT_EQ(trial.Replay().rfind(lands ? "touchdown land " : "touchdown fly ", 0), 0U);
    const std::string seed = " --seed " + std::to_string(trial.seed);
    EXPECT_EQ(trial.Replay().substr(trial.Replay().size() - seed.size()), seed);
    ASSERT_EQ(trial.varied.size(), plan.campaign.keys.size());
    seeds[{trial.varied.at(0).second, trial.varied.at(1).second}].push_back(trial.seed);
  }
  for (const auto& [part, own] : seeds) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      EXPECT_EQ(own[i], TrialSeed(plan.campaign.seed, static_cast<int>(i))) << part.first;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedStudy, testing::ValuesIn(ListStudyFiles()));

TEST(PaperStudy, HasTheSampleSizesThatWereFixed) {
  const StudyPlan plan = Shipped("paper", false);
  const auto counts = Counts(plan);
  const auto scenarios_assume = [&](const std::string& cell) {
    for (const SweepTrial& trial : plan.campaign.trials) {
      if (trial.varied.at(0).second != cell) continue;
      return trial.scenario.own_state == OwnStateKind::kTrue && trial.scenario.plant.mass == 1.0;
    }
    return false;
  };
  std::set<std::string> cells, without;
  for (const auto& [part, count] : counts) {
    const bool assumes = scenarios_assume(part.first);
    if (part.first != "figure_4_following") (assumes ? cells : without).insert(part.first);
    const std::set<std::string> large = {"planned", "vertical", "ego"};
    EXPECT_EQ(count, large.count(part.second) > 0 ? 100 : 30) << part.first << " " << part.second;
  }
  EXPECT_EQ(cells.size(), 15U);   // Figure 4, two cases with three sigmas and four winds
  EXPECT_EQ(without.size(), 6U);  // own state, vehicle, both in noise and wind
  for (const std::string& cell : without) {
    for (const char* method : {"planned", "vertical", "ego", "ego_velocity_10hz"}) {
      EXPECT_EQ(counts.count({cell, method}), 1U) << cell << " " << method;
    }
  }
  for (const std::string& cell : cells) {
    for (const char* method :
         {"planned", "vertical", "vertical_2mps", "oracle", "ego", "ego_2hz", "ego_10hz",
          "ego_3mps", "ego_velocity", "ego_velocity_10hz", "pid"}) {
      EXPECT_EQ(counts.count({cell, method}), 1U) << cell << " " << method;
    }
  }
}

TEST(PaperStudy, FliesThePapersConditions) {
  const StudyPlan plan = Shipped("paper", true);
  std::map<std::string, const Scenario*> scenarios;
  for (const SweepTrial& trial : plan.campaign.trials) {
    scenarios.emplace(trial.varied.at(0).second, &trial.scenario);
    EXPECT_EQ(trial.scenario.pad.speed, 0.8);
    EXPECT_EQ(trial.scenario.start.position_spread, Eigen::Vector3d::Ones());
    const std::string& method = trial.varied.at(1).second;
    if (method.rfind("ego", 0) == 0 && method != "ego_3mps") {  // as published
      EXPECT_EQ(trial.scenario.limits.speed, 2.0);
      EXPECT_EQ(trial.scenario.limits.acceleration, 3.0);
    }
  }
  EXPECT_EQ(scenarios.at("case_2_sigma_0.5")->gps.sigma, 0.5);
  EXPECT_EQ(scenarios.at("case_2_sigma_0.5")->pad.turn_rate, 0.15);
  EXPECT_EQ(scenarios.at("case_1_wind_11")->wind.mean, 11.0);
  EXPECT_EQ(scenarios.at("case_1_wind_11")->wind.max, 15.0);
  EXPECT_EQ(scenarios.at("figure_4")->pad.motion, "line");
}

TEST(SolversStudy, HasEveryBackendOrSaysWhyNot) {
  const StudyPlan plan = Shipped("solvers", true);
  std::set<std::string> soft, hard;
  for (const StudyPart& part : plan.parts) {
    const std::string& name = plan.MethodOf(part).name;
    if (plan.CellOf(part).name == "case_1" && part.trials > 0) soft.insert(name);
    if (plan.CellOf(part).name != "case_1_hard") continue;
    EXPECT_NE(part.trials > 0, !part.refusal.empty()) << name;
    if (part.trials > 0) hard.insert(name);
  }
  for (const SweepTrial& trial : plan.campaign.trials) {
    const std::string& cell = trial.varied.at(0).second;
    EXPECT_EQ(trial.FliesAlone(), cell.find("measured") != std::string::npos) << cell;
  }
  EXPECT_EQ(soft.size(), kRegistries.backends.size());
  EXPECT_EQ(hard.count("banded"), 1U);
  EXPECT_EQ(hard.count("lbfgs"), 0U);
}

class WrittenStudy : public testing::Test {
 protected:
  ~WrittenStudy() override { std::filesystem::remove(path_); }

  StudyFile Load(const std::string& text) const {
    std::ofstream(path_) << text;
    return LoadStudyFile(path_, kRegistries);
  }
  /// The sentence that loading it, or planning it, is refused with.
  std::string Refusal(const std::string& text) const {
    try {
      PlanStudy(Load(text), {.quick = true}, 1, kRegistries);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }

  static constexpr char kHead[] = "title: t\nseed: 1\nreference: a\n";
  std::string path_ = testing::TempDir() + "written_study.yaml";
};

TEST_F(WrittenStudy, AMethodsKeyCountsNotTheCells) {
  const StudyFile file =
      Load(std::string(kHead) +
           "set: {timeout: 9, task: follow}\n"
           "cells: [{name: c, scenario: open, set: {timeout: 8}}]\n"
           "methods: [{name: a, set: {timeout: 7}, quick: 2, record: [c]}, {name: b}]\n");
  const StudyPlan plan = PlanStudy(file, {.quick = true}, 4, kRegistries);
  ASSERT_EQ(plan.parts.size(), 2U);
  EXPECT_TRUE(plan.Records(plan.parts[0]));
  EXPECT_FALSE(plan.Records(plan.parts[1]));
  EXPECT_EQ(plan.parts[0].trials, 2);
  EXPECT_EQ(plan.campaign.trials.at(0).scenario.timeout, 7.0);
  EXPECT_EQ(plan.campaign.trials.at(2).scenario.timeout, 8.0);
  EXPECT_EQ(plan.campaign.trials.at(2).scenario.task, TaskKind::kFollow);
}

// A part that is flown again is the part of the whole.
TEST_F(WrittenStudy, ASelectionHasTheSeedsOfTheWhole) {
  const StudyFile file =
      Load(std::string(kHead) +
           "cells: [{name: c, scenario: open}, {name: d, scenario: circle, quick: false},"
           " {name: e, scenario: open, methods: [b]}]\n"
           "methods: [{name: a, trials: 3}, {name: b, set: {timeout: 7}, trials: 4}]\n");
  const StudyPlan whole = PlanStudy(file, {}, 4, kRegistries);
  const StudyPlan part = PlanStudy(file, {.cells = {"d"}, .methods = {"b"}}, 4, kRegistries);
  ASSERT_EQ(part.campaign.trials.size(), 4U);
  const StudyPart& of_whole = whole.parts.at(3);
  ASSERT_EQ(whole.CellOf(of_whole).name + whole.MethodOf(of_whole).name, "db");
  for (int i = 0; i < 4; ++i) {
    const SweepTrial& one = part.campaign.trials.at(static_cast<std::size_t>(i));
    const SweepTrial& other =
        whole.campaign.trials.at(static_cast<std::size_t>(of_whole.first + i));
    EXPECT_EQ(one.index, i);
    EXPECT_EQ(one.Replay(), other.Replay());
    EXPECT_EQ(one.varied, other.varied);
    EXPECT_EQ(DumpScenario(one.scenario), DumpScenario(other.scenario));
  }
  const StudyPlan more = PlanStudy(file, {.methods = {"a"}, .trials = 9}, 4, kRegistries);
  EXPECT_EQ(more.campaign.trials.size(), 18U);
  EXPECT_EQ(more.campaign.trials.at(8).seed, TrialSeed(4, 8));
  const auto refusal = [&](const StudySelection& selection) -> std::string {
    try {
      PlanStudy(file, selection, 4, kRegistries);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  };
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(refusal({.cells = {"f"}}), AllOf(HasSubstr("--cells f"), HasSubstr("c, d")));
  EXPECT_THAT(refusal({.methods = {"z"}}), AllOf(HasSubstr("--methods z"), HasSubstr("a")));
  EXPECT_THAT(refusal({.cells = {"e"}, .methods = {"a"}}), HasSubstr("none of these methods"));
  EXPECT_THAT(refusal({.quick = true, .cells = {"d"}}), HasSubstr("in the short form"));
}

TEST_F(WrittenStudy, ScenarioFilesBesideTheStudyAreFound) {
  const std::string beside = testing::TempDir() + "beside_the_study.yaml";
  std::ofstream(beside) << "timeout: 17\n";
  const std::string rest =
      "cells: [{name: c, scenario: beside_the_study.yaml}]\nmethods: [{name: a}]\n";
  const StudyPlan plan = PlanStudy(Load(kHead + rest), {.quick = true}, 1, kRegistries);
  EXPECT_EQ(plan.campaign.trials.at(0).scenario.timeout, 17.0);
  EXPECT_THAT(plan.campaign.trials.at(0).command, testing::HasSubstr(beside));
  std::filesystem::remove(beside);
}

TEST_F(WrittenStudy, MistakesAreNamed) {
  const std::string head = kHead;
  const std::string cells = "cells: [{name: c, scenario: open}]\n";
  const std::string methods = "methods: [{name: a}]\n";
  const std::pair<std::string, const char*> mistakes[] = {
      {head + cells, "a study needs a cell and a method"},
      {"title: t\n" + cells + methods, "a study lacks the key reference"},
      {head + cells + "methods: [{name: b}]\n", "reference must be one of the methods, not a"},
      {head + cells + "methods: [{name: a}, {name: a}]\n", "must be unique"},
      {head + cells + "methods: [{name: a/b}]\n", "made of letters"},
      {head + cells + "methods: [{name: a, trials: 0}]\n", ".yaml:5: trials must be"},
      {head + "cells: [{name: c}]\n" + methods, "cells[0] lacks the key scenario"},
      {head + "cells: [{name: c, scenario: open, methods: [z]}]\n" + methods, "the method z"},
      {head + "cells: [{name: c, scenario: open}, {name: d, scenario: open, labels: {x: 1}}]\n" +
           methods,
       "must have the labels of the first cell"},
      {head + "cells: [{name: c, scenario: nowhere}]\n" + methods, "nowhere"},
      {head + cells + "methods: [{name: a, set: {pad.sped: 1}}]\n", "unknown key pad.sped"},
      {head + cells + "methods: [{name: a, record: [d]}]\n", "the cell d, which is not there"},
      {head + cells + methods + "backends: {set: 3}\n", "must be a map of keys"},
      {head + cells + "methods: [", ".yaml:"}};
  for (const auto& [text, part] : mistakes) {
    EXPECT_NE(Refusal(text).find(part), std::string::npos) << text << "\n" << Refusal(text);
  }
}

}  // namespace
}  // namespace touchdown::evaluation
