// SPDX-License-Identifier: BSD-3-Clause
// Problems are those of the flights, and a listener does not change a flight.
#include "evaluation/compare/compare.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/campaign.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/compare/source_flights.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/record.h"
#include "evaluation/studies/hostile/hostile_study.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;

class Flights : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  // Starts of all solves that the flight asks for, and the costs there.
  std::vector<Eigen::VectorXd> Asked(const SourceFlight& flight) const {
    std::vector<Eigen::VectorXd> starts;
    Registries overheard = registries_;
    overheard.backends = solvers::Overheard(
        registries_.backends,
        [&](const solvers::SolveRequest& asked) { starts.push_back(asked.start.y); });
    flight.fly(overheard);
    return starts;
  }

  static SourceFlight FlownAs(const SweepTrial& trial) {
    return {"", [trial](const Registries& overheard) {
              RunTrial(trial.scenario, trial.seed, overheard);
              return std::string();
            }};
  }

  CompareResult Compared(const CompareOptions& options) const {
    return RunCompare(options, registries_, [](int, int) {});
  }

  std::string Refusal(const CompareOptions& options) const {
    try {
      Compared(options);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }

  const Registries registries_ = StandardRegistries();
  const std::string path_ = ::testing::TempDir() + "compare.db";
};

const std::vector<std::string> kShort = {"timeout=1.5"};

TEST_F(Flights, DrawnOnesRepeatAndAlternate) {
  const FlightSource one = DrawnFlights(3, kShort, registries_);
  EXPECT_FALSE(one.flights);
  EXPECT_THAT(one.flight(0).command, HasSubstr("land forest --set timeout=1.5 --seed "));
  EXPECT_THAT(one.flight(1).command,
              HasSubstr("study hostile --seed 3 --share-beyond 0 --set timeout=1.5 --only 0"));
  const std::vector<Eigen::VectorXd> asked = Asked(one.flight(1));
  EXPECT_GT(asked.size(), 5U);
  EXPECT_EQ(asked, Asked(DrawnFlights(3, kShort, registries_).flight(1)));
  EXPECT_NE(asked, Asked(DrawnFlights(4, kShort, registries_).flight(1)));
}

TEST_F(Flights, ARecordAsksWhatTheFlightAsked) {
  const Scenario scenario = LoadScenario(FindScenario("forest"), kShort, registries_);
  std::vector<Eigen::VectorXd> flown;
  TrialRecord record;
  const SourceFlight flight{"", [&](const Registries& overheard) {
                              WriteRecord(path_, scenario,
                                          RunTrial(scenario, 1, overheard, &record), record);
                              return std::string();
                            }};
  flown = Asked(flight);
  const FlightSource source = FlightsOf(path_, {}, registries_);
  EXPECT_EQ(source.flights, 1);
  EXPECT_EQ(Asked(source.flight(0)), flown);
  EXPECT_GT(flown.size(), 5U);
}

TEST_F(Flights, TheTrialsOfAFileAreFlownAgain) {
  SweepOptions sweep;
  sweep.scenario_path = FindScenario("forest");
  sweep.overrides = kShort;
  sweep.variations = {Variation::Parse("gps.sigma=0.1,0.4", StandardRegistries())};
  sweep.trials = 2;
  const Campaign campaign = SweepCampaign(sweep, registries_);
  CampaignOptions options;
  options.db = path_;
  RunCampaign(campaign, options, registries_, [](const CampaignState&) {});
  const FlightSource source = FlightsOf(path_, {}, registries_);
  EXPECT_EQ(source.flights, static_cast<int>(campaign.trials.size()));
  const SweepTrial& trial = campaign.trials.back();
  EXPECT_EQ(source.flight(trial.index).command, trial.Replay());
  EXPECT_EQ(Asked(source.flight(trial.index)), Asked(FlownAs(trial)));
}

TEST_F(Flights, ThoseOfTheHostileStudyToo) {
  HostileOptions options;
  options.seed = 5;
  options.flights = 2;
  options.share_beyond = 0.0;
  options.set = kShort;
  const Campaign campaign = HostileCampaign(options, DrawHostileFlights(options, 1, registries_));
  CampaignOptions flight;
  flight.db = path_;
  RunCampaign(campaign, flight, registries_, [](const CampaignState&) {});
  const FlightSource source = FlightsOf(path_, {}, registries_);
  EXPECT_EQ(source.flights, 2);
  EXPECT_THAT(source.flight(1).command, HasSubstr("study hostile --seed 5"));
  EXPECT_EQ(source.flight(1).fly(registries_), "") << "the same flight again";
  EXPECT_EQ(Asked(source.flight(1)), Asked(FlownAs(campaign.trials[1])));
}

// The file has the results of its trials. Trials that are flown again must have the same results.
TEST_F(Flights, AnotherFlightThanTheFilesIsNoted) {
  SweepOptions sweep;
  sweep.scenario_path = FindScenario("forest");
  sweep.overrides = kShort;
  sweep.trials = 2;
  CampaignOptions options;
  options.db = path_;
  RunCampaign(SweepCampaign(sweep, registries_), options, registries_, [](const CampaignState&) {});
  SqliteDb(path_, SqliteDb::Mode::kReadWrite)
      .Execute(
          "UPDATE trial SET simulated_s = 1.25 WHERE trial = 0; "
          "UPDATE trial SET outcome = 'hung' WHERE trial = 1");
  const FlightSource source = FlightsOf(path_, {}, registries_);
  EXPECT_EQ(source.flights, 1) << "what hung is not flown again";
  EXPECT_THAT(source.flight(0).fly(registries_), HasSubstr("was timeout after 1.25 s"));
  CompareOptions compare;
  compare.from = path_;
  compare.problems = 100000;
  compare.every = 40;
  compare.bench.backends = {"banded"};
  EXPECT_EQ(Compared(compare).notes.size(), 1U);
}

TEST_F(Flights, OtherFilesAreRefused) {
  for (const std::string& none : {path_, testing::TempDir()}) {
    try {
      FlightsOf(none, {}, registries_);
      FAIL() << none;
    } catch (const BadInput& refusal) {
      EXPECT_THAT(refusal.what(), HasSubstr(none + ": there is no such file"));
    }
  }
  SqliteDb(path_, SqliteDb::Mode::kCreate).Execute("CREATE TABLE manifest(key TEXT, value TEXT)");
  EXPECT_THROW(FlightsOf(path_, {}, registries_), BadInput);
  EXPECT_THAT(Refusal({.set = {"planning.latency=measured"}}), HasSubstr("depends on the clock"));
}

TEST_F(Flights, AFlightDoesNotKnowWhoListens) {
  const Scenario scenario = LoadScenario(FindScenario("forest"), {"timeout=3"}, registries_);
  TrialRecord alone, heard;
  RunTrial(scenario, 5, registries_, &alone);
  SolverBench bench({.backends = {"banded", "lbfgs"}, .repeats = 1}, registries_.backends,
                    registries_.terms);
  Registries overheard = registries_;
  int solve = 0;
  overheard.backends =
      solvers::Overheard(registries_.backends, [&](const solvers::SolveRequest& asked) {
        if (solve++ % 5 == 0) bench.Run(asked, 0, solve);
      });
  RunTrial(scenario, 5, overheard, &heard);
  EXPECT_GT(bench.result().problems.size(), 3U);
  ASSERT_EQ(alone.plans.size(), heard.plans.size());
  for (std::size_t i = 0; i < alone.plans.size(); ++i) {
    EXPECT_TRUE(Same(alone.plans[i].result, heard.plans[i].result)) << i;
  }
}

TEST_F(Flights, BackendsAgreeOnWhatIsFlown) {
  CompareOptions options;
  options.problems = 8;
  options.every = 9;
  options.bench.backends = {"banded", "lbfgs", "ipopt"};
  options.bench.repeats = 1;
  const CompareResult result = Compared(options);
  ASSERT_EQ(result.problems.size(), 8U);
  EXPECT_EQ(result.every, 9);
  EXPECT_GT(result.asked, 7 * 9);
  int with_pairs = 0;
  for (const ProblemRow& row : result.problems) {
    EXPECT_EQ(row.solve % 9 == 0, true) << "of the first flight";
    EXPECT_TRUE(std::isfinite(row.reference_cost));
    with_pairs += row.pairs > 0;
  }
  EXPECT_GT(with_pairs, 0);
  for (const SolveRow& row : result.solves) {
    if (row.phase == SolvePhase::kTight && row.status == solvers::SolveStatus::kConverged) {
      EXPECT_LE(row.gap, 1e-4) << row.backend << " " << row.problem;
    }
  }
}

TEST_F(Flights, WhatNobodyCanSolveIsRefused) {
  CompareOptions options;
  options.set = {"solver.limits=hard"};
  options.bench.backends = {"ceres"};
  EXPECT_THAT(Refusal(options), HasSubstr("ceres takes no inequality constraints"));
  EXPECT_THAT(Refusal({.set = {"planner=ego"}}), HasSubstr("no solver backend is asked"));
}

}  // namespace
}  // namespace touchdown::evaluation
