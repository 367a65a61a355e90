// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/sweep.h"

#include <map>
#include <optional>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/campaign/sweep_cells.h"
#include "evaluation/campaign/sweep_report.h"
#include "touchdown/evaluation/base/shipped_files.h"

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
  const Variation range = Variation::Parse("pad.speed=0.5..1.5", StandardRegistries());
  EXPECT_TRUE(range.values.empty());
  EXPECT_EQ(range.lo, 0.5);
  EXPECT_EQ(range.hi, 1.5);
  const Variation list = Variation::Parse("controller=geometric,paper", StandardRegistries());
  EXPECT_EQ(list.values, (std::vector<std::string>{"geometric", "paper"}));
}

TEST(Variation, RefusesNonsense) {
  EXPECT_THROW(Variation::Parse("pad.speed", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("pad.sped=1,2", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("seed=1,2", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=2..1", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=a..1", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=0.2,0.4,0.2", StandardRegistries()), BadInput);
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
  options.variations = {Variation::Parse("controller=geometric,paper", StandardRegistries()),
                        Variation::Parse("pad.speed=0.2,0.4,0.6", StandardRegistries())};
  std::set<std::string> seen;
  for (const SweepTrial& trial : PlanSweep(options, kRegistries)) {
    seen.insert(trial.varied[0].second + trial.varied[1].second);
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(PlanSweep, AKeyIsVariedOnceAndNotSetBeside) {
  SweepOptions options = OpenSweep(2);
  options.variations = {Variation::Parse("pad.speed=0.2..0.6", StandardRegistries())};
  options.overrides.push_back("pad.speed=1");
  EXPECT_THROW(PlanSweep(options, kRegistries), BadInput);
  options.overrides.pop_back();
  EXPECT_NO_THROW(PlanSweep(options, kRegistries));
  options.variations.push_back(Variation::Parse("pad.speed=0.2,0.4", StandardRegistries()));
  EXPECT_THROW(PlanSweep(options, kRegistries), BadInput);
}

TEST(PlanSweep, ARefusalSaysWhatWasVaried) {
  SweepOptions options;
  options.scenario_path = FindScenario("open");
  options.variations = {Variation::Parse("planning.latency=20,180", StandardRegistries())};
  try {
    PlanSweep(options, kRegistries);
    ADD_FAILURE() << "180 ms are more than a period";
  } catch (const BadInput& refusal) {
    EXPECT_THAT(refusal.what(), testing::StartsWith("With --vary planning.latency=180: "));
    EXPECT_THAT(refusal.what(), testing::HasSubstr("planning.latency must be in [0, 100] ms"));
  }
}

TEST(PlanSweep, RangesAreDrawnPerTrialAndChecked) {
  SweepOptions options = OpenSweep(20);
  options.variations = {Variation::Parse("pad.speed=0.2..0.6", StandardRegistries())};
  std::set<double> speeds;
  for (const SweepTrial& trial : PlanSweep(options, kRegistries)) {
    EXPECT_GE(trial.scenario.pad.speed, 0.2);
    EXPECT_LE(trial.scenario.pad.speed, 0.6);
    speeds.insert(trial.scenario.pad.speed);
  }
  EXPECT_EQ(speeds.size(), 20U);
  // Both ends of a range and every listed value, before any seed is drawn.
  EXPECT_THROW(Variation::Parse("pad.speed=50..60", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("pad.speed=0.2..60", StandardRegistries()), BadInput);
  EXPECT_THROW(Variation::Parse("controller=geometric,psychic", StandardRegistries()), BadInput);
}

TEST(SweepReport, EveryFigureStandsUnderItsOwnName) {
  const Campaign campaign = SweepCampaign(OpenSweep(1), kRegistries);
  SweepRow row;
  row.trial = campaign.trials.front();
  row.trial.scenario.descent = DescentKind::kVertical;
  TrialResult& r = row.result;
  r.outcome = Outcome::kLanded;
  r.touchdown.emplace();
  r.touchdown->t = 6.0;
  r.touchdown->error_m = 0.2;
  r.touchdown->relative_velocity << 0.3, 0.4, -1.2;
  r.touchdown->tilt_over_equilibrium = 0.1;
  r.mean_abs_error_x_m = 0.5;
  r.mean_abs_error_y_m = 0.6;
  r.min_clearance_m = 0.7;
  r.estimator.emplace().nees_position_mean = 0.8;
  r.own_state.emplace().rmse_position_m = 0.9;
  r.t_star_s = 4.0;
  r.t_star_upper_s = 5.0;
  r.within_limits = true;
  const auto summary = SweepJson(campaign, {row})["summary"];
  const std::map<std::string, double> expected = {
      {"time_to_land_s", 6.0},        {"touchdown_error_m", 0.2},
      {"relative_speed_mps", 1.3},    {"relative_horizontal_mps", 0.5},
      {"relative_vertical_mps", 1.2}, {"tilt_over_equilibrium_deg", 5.729577951308232},
      {"mean_abs_error_x_m", 0.5},    {"mean_abs_error_y_m", 0.6},
      {"min_clearance_m", 0.7},       {"estimator_nees_position", 0.8},
      {"own_rmse_position_m", 0.9},   {"t_star_s", 4.0},
      {"t_star_gap", 0.25},           {"time_ratio", 1.5}};
  for (const auto& [key, value] : summary.items()) {
    if (expected.count(key) == 0) {
      EXPECT_EQ(value["n"], 0) << key;
      continue;
    }
    EXPECT_EQ(value["n"], 1) << key;
    EXPECT_NEAR(value["median"].get<double>(), expected.at(key), 1e-12) << key;
  }
  for (const auto& [key, value] : expected) EXPECT_TRUE(summary.contains(key)) << key << value;
  // Five seconds before contact a planned descent is still on its way.
  row.trial.scenario.descent = DescentKind::kPlanned;
  EXPECT_EQ(SweepJson(campaign, {row})["summary"]["mean_abs_error_x_m"]["n"], 0);
  EXPECT_EQ(SweepText(campaign, {row}).find("last 5 s"), std::string::npos);
  // Only contents of the table are explained.
  EXPECT_NE(SweepText(campaign, {row}).find("; T*: no flight"), std::string::npos);
  row.result.t_star_s.reset();
  const std::string text = SweepText(campaign, {row});
  EXPECT_NE(text.find("n: trials that have the figure; p95: "), std::string::npos);
  EXPECT_EQ(text.find("T*"), std::string::npos);
}

TrialResult After(std::optional<double> landed_after_s) {
  TrialResult result;
  result.outcome = landed_after_s ? Outcome::kLanded : Outcome::kTimeout;
  if (landed_after_s) {
    result.touchdown.emplace();
    result.touchdown->t = *landed_after_s;
    result.touchdown->error_m = 0.01 * *landed_after_s;
  }
  return result;
}

TEST(SweepCells, GatherTrialsByTheirListedValues) {
  SweepOptions options = OpenSweep(7);
  options.variations = {Variation::Parse("controller=geometric,paper", StandardRegistries()),
                        Variation::Parse("gps.sigma=0.1..0.5", StandardRegistries()),
                        Variation::Parse("pad.speed=0.2,0.4,0.6", StandardRegistries())};
  const CellPlan plan = PlanCells(SweepCampaign(options, kRegistries));
  ASSERT_EQ(plan.cells.size(), 6U);
  using Values = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(plan.cells[0].values, (Values{{"controller", "geometric"}, {"pad.speed", "0.2"}}));
  EXPECT_EQ(plan.cells[5].values, (Values{{"controller", "paper"}, {"pad.speed", "0.6"}}));
  EXPECT_EQ(plan.cells[0].trials, 2);  // the first and the last of seven
  EXPECT_EQ(plan.cells[1].trials, 1);
  EXPECT_EQ(plan.cell_of, (std::vector<int>{0, 1, 2, 3, 4, 5, 0}));
}

TEST(SweepCells, FiguresAreOfTheFlownAndTimesOfTheLanded) {
  CellTally tally;
  EXPECT_EQ(tally.Figures().trials, 0);
  EXPECT_FALSE(tally.Figures().rate);
  tally.Add(After(5.0));
  tally.Add(After(11.0));
  EXPECT_EQ(tally.Figures().succeeded, 2);
  EXPECT_DOUBLE_EQ(*tally.Figures().time_to_land_median_s, 8.0);
  EXPECT_DOUBLE_EQ(*tally.Figures().touchdown_error_median_m, 0.08);
  CellTally failed;
  failed.Add(After({}));
  EXPECT_EQ(failed.Figures().succeeded, 0);
  EXPECT_FALSE(failed.Figures().time_to_land_median_s);
  EXPECT_DOUBLE_EQ(failed.Figures().rate->lo, 0.0);
  EXPECT_NEAR(failed.Figures().rate->hi, 0.975, 1e-12);  // 1 - 0.025^(1/n)
}

TEST(SweepCells, ARangeMakesOneCell) {
  SweepOptions options = OpenSweep(4);
  options.variations = {Variation::Parse("pad.speed=0.2..0.6", StandardRegistries())};
  const CellPlan plan = PlanCells(SweepCampaign(options, kRegistries));
  ASSERT_EQ(plan.cells.size(), 1U);
  EXPECT_TRUE(plan.cells[0].values.empty());
  EXPECT_EQ(plan.cells[0].trials, 4);
}

}  // namespace
}  // namespace touchdown::evaluation
