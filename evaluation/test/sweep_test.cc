// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/sweep.h"

#include <set>

#include <gtest/gtest.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/sweep_report.h"

namespace touchdown::evaluation {
namespace {

const Registries kRegistries = StandardRegistries();

SweepOptions OpenSweep(int trials) {
  SweepOptions options;
  options.scenario_path = FindScenario("open");
  options.overrides = {"start.position_spread=[1, 1, 0]", "timeout=3"};
  options.trials = trials;
  options.seed = 7;
  return options;
}

TEST(Variation, ParsesRangesAndLists) {
  const Variation range = Variation::Parse("pad.speed=0.5..1.5");
  EXPECT_TRUE(range.values.empty());
  EXPECT_EQ(range.lo, 0.5);
  EXPECT_EQ(range.hi, 1.5);
  const Variation list = Variation::Parse("controller=geometric,paper");
  EXPECT_EQ(list.values, (std::vector<std::string>{"geometric", "paper"}));
}

TEST(Variation, RefusesNonsense) {
  EXPECT_THROW(Variation::Parse("pad.speed"), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed="), BadInput);
  EXPECT_THROW(Variation::Parse("pad.sped=1,2"), BadInput);
  EXPECT_THROW(Variation::Parse("seed=1,2"), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=2..1"), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=a..1"), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=0.2,0.4,0.2"), BadInput);
}

TEST(PlanSweep, SeedsAreDistinctAndRepeat) {
  std::set<std::uint64_t> seeds;
  for (int i = 0; i < 1000; ++i) seeds.insert(TrialSeed(1, i));
  for (int i = 0; i < 1000; ++i) seeds.insert(TrialSeed(2, i));
  EXPECT_EQ(seeds.size(), 2000U);
  EXPECT_EQ(TrialSeed(1, 5), TrialSeed(1, 5));
}

TEST(PlanSweep, ListsAreTakenInAllCombinations) {
  SweepOptions options = OpenSweep(6);
  options.variations = {Variation::Parse("controller=geometric,paper"),
                        Variation::Parse("pad.speed=0.2,0.4,0.6")};
  std::set<std::string> seen;
  for (const SweepTrial& trial : PlanSweep(options, kRegistries)) {
    seen.insert(trial.varied[0].second + trial.varied[1].second);
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(PlanSweep, AKeyIsVariedOnceAndNotSetBeside) {
  SweepOptions options = OpenSweep(2);
  options.variations = {Variation::Parse("pad.speed=0.2..0.6")};
  options.overrides.push_back("pad.speed=1");
  EXPECT_THROW(PlanSweep(options, kRegistries), BadInput);
  options.overrides.pop_back();
  EXPECT_NO_THROW(PlanSweep(options, kRegistries));
  options.variations.push_back(Variation::Parse("pad.speed=0.2,0.4"));
  EXPECT_THROW(PlanSweep(options, kRegistries), BadInput);
}

TEST(PlanSweep, RangesAreDrawnPerTrialAndChecked) {
  SweepOptions options = OpenSweep(20);
  options.variations = {Variation::Parse("pad.speed=0.2..0.6")};
  std::set<double> speeds;
  for (const SweepTrial& trial : PlanSweep(options, kRegistries)) {
    EXPECT_GE(trial.scenario.pad.speed, 0.2);
    EXPECT_LE(trial.scenario.pad.speed, 0.6);
    speeds.insert(trial.scenario.pad.speed);
  }
  EXPECT_EQ(speeds.size(), 20U);
  // Both ends of a range and every listed value, before any seed is drawn.
  EXPECT_THROW(Variation::Parse("pad.speed=50..60"), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=0.2..60"), BadInput);
  EXPECT_THROW(Variation::Parse("controller=geometric,psychic"), BadInput);
}

TEST(RunSweep, ATrialThatThrowsIsARowAndNotTheEnd) {
  SweepOptions options = OpenSweep(3);
  std::vector<SweepTrial> trials = PlanSweep(options, kRegistries);
  trials[1].scenario.solver.backend = "none";
  const std::vector<SweepRow> rows = RunSweep(trials, 2, StandardRegistries(), [](int, int) {});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].result.outcome, Outcome::kError);
  EXPECT_FALSE(rows[1].result.detail.empty());
  EXPECT_NE(rows[0].result.outcome, Outcome::kError);
  const std::string text = SweepText(options, rows);
  EXPECT_NE(text.find("1 x error"), std::string::npos);
}

// Between the buildings: search, pairs and the map take part.
TEST(RunSweep, OneAndTwoThreadsGiveTheSameRows) {
  SweepOptions options = OpenSweep(4);
  options.scenario_path = FindScenario("straight_turn");
  options.overrides = {"start.position_spread=[1, 1, 0]", "start.yaw_random=true", "timeout=4"};
  const std::vector<SweepTrial> trials = PlanSweep(options, kRegistries);
  const auto rows = [&](int jobs) {
    nlohmann::ordered_json json =
        SweepJson(options, RunSweep(trials, jobs, StandardRegistries(), [](int, int) {}));
    json.erase("wall_clock");
    return json.dump();
  };
  const std::string one = rows(1);
  EXPECT_EQ(one, rows(2));
  EXPECT_EQ(one, rows(1));
}

}  // namespace
}  // namespace touchdown::evaluation
