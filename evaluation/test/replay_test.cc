// SPDX-License-Identifier: BSD-3-Clause
// A record holds all that its replanning steps depend on: asked again, they answer the same bits.
#include "evaluation/record/replay.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/record.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

class Replayed : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  void Fly(const std::string& scenario_name, const std::vector<std::string>& overrides) {
    const Scenario scenario = LoadScenario(FindScenario(scenario_name), overrides, registries_);
    WriteRecord(path_, scenario, RunTrial(scenario, scenario.seed, registries_, &flown_), flown_);
  }

  void Execute(const std::string& sql) { SqliteDb(path_, SqliteDb::Mode::kReadWrite).Execute(sql); }

  std::string Refusal() {
    try {
      ReadRecord(path_, {}, registries_);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }

  const Registries registries_ = StandardRegistries();
  TrialRecord flown_;
  std::string path_ = ::testing::TempDir() + "replay.db";
};

// Every step of a flight, in two orders.
void ExpectTheSameBits(const RecordedFlight& flight, const Registries& registries) {
  Replay replay(flight, registries);
  for (int step = 0; step < replay.steps(); ++step) {
    replay.Seek(step);
    for (int repeat = 0; repeat < 2; ++repeat) {
      ASSERT_TRUE(Same(OutcomeOf(replay.Solve()), replay.recorded().result)) << "step " << step;
    }
  }
  for (int step = replay.steps() - 1; step >= 0; step -= 17) {
    replay.Seek(step);
    ASSERT_TRUE(Same(OutcomeOf(replay.Solve()), replay.recorded().result)) << "step " << step;
  }
}

TEST_F(Replayed, TheFirstCaseBitForBit) {
  Fly("straight_turn", {});
  const RecordedFlight flight = ReadRecord(path_, {}, registries_);
  ASSERT_EQ(flight.plans.size(), flown_.plans.size());
  ASSERT_GT(flight.plans.size(), 50u);
  EXPECT_EQ(DumpScenario(flight.scenario),
            DumpScenario(LoadScenario(FindScenario("straight_turn"), {}, registries_)));
  int with_costs = 0;
  for (std::size_t i = 0; i < flight.plans.size(); ++i) {
    EXPECT_TRUE(Same(flight.plans[i].result, flown_.plans[i].result)) << i;
    const ReplanOutcome& result = flight.plans[i].result;
    double cost = 0.0;
    for (const solvers::TermCost& term : result.cost_by_term) cost += term.cost;
    EXPECT_NEAR(cost, result.cost, 1e-9 * result.cost) << i;
    with_costs += !result.cost_by_term.empty();
    const planning::ReplannerState &read = flight.plans[i].before, &flown = flown_.plans[i].before;
    EXPECT_EQ(read.current.from_unknown, flown.current.from_unknown) << i;
    EXPECT_EQ(read.next.from_unknown, flown.next.from_unknown) << i;
  }
  EXPECT_GT(with_costs, 50);
  EXPECT_FALSE(flown_.plans.back().before.next.from_unknown);
  ExpectTheSameBits(flight, registries_);
}

// Over a pad that stands: while it goes to look.
TEST_F(Replayed, WhereItLooksFromToo) {
  Fly("open", {"pad.motion=static", "pad.start=[0, 0]", "start.position=[0, 0, 2]", "timeout=15",
               "seed=4"});
  const RecordedFlight flight = ReadRecord(path_, {}, registries_);
  int looks = 0;
  for (std::size_t i = 0; i < flight.plans.size(); ++i) {
    const auto& look = flight.plans[i].request.input.look_from_W;
    EXPECT_EQ(look, flown_.plans[i].request.input.look_from_W) << i;
    looks += look.has_value() ? 1 : 0;
  }
  EXPECT_GT(looks, 5);
  ExpectTheSameBits(flight, registries_);
}

// Steps that ran out of their budget, and where the next ones went on.
TEST_F(Replayed, WhatWasNotFinishedToo) {
  Fly("forest", {"planning.max_work=1000", "timeout=12"});
  const RecordedFlight flight = ReadRecord(path_, {}, registries_);
  int unfinished = 0;
  for (std::size_t i = 0; i < flight.plans.size(); ++i) {
    const std::optional<planning::Attempt>& read = flight.plans[i].before.unfinished;
    const std::optional<planning::Attempt>& flown = flown_.plans[i].before.unfinished;
    ASSERT_EQ(read.has_value(), flown.has_value()) << i;
    if (!read) continue;
    EXPECT_EQ(read->number, flown->number) << i;
    EXPECT_EQ(read->duration, flown->duration) << i;
    EXPECT_EQ(read->arrival, flown->arrival) << i;
    ++unfinished;
  }
  EXPECT_GE(unfinished, 3);
  ExpectTheSameBits(flight, registries_);
}

TEST_F(Replayed, OtherPredictionsAndBackendsToo) {
  const std::vector<std::vector<std::string>> cases = {
      {"pad.prediction=oracle", "start.position_spread=[1, 1, 1]", "pad.phase_spread=2", "seed=7"},
      {"pad.prediction=paper", "estimator.pad=paper", "solver.arrival=free"},
      {"solver.backend=nlopt-lbfgs", "gps.sigma=0.5"},
      {"planning.endpoint_velocity=rest", "planning.warm_start=false"}};
  for (const auto& overrides : cases) {
    flown_ = {};
    std::vector<std::string> all = overrides;
    all.push_back("timeout=5");
    Fly("straight_turn", all);
    const RecordedFlight flight = ReadRecord(path_, {}, registries_);
    ASSERT_GT(flight.plans.size(), 10u);
    ExpectTheSameBits(flight, registries_);
  }
}

TEST_F(Replayed, ABadRecordIsRefusedInASentence) {
  EXPECT_THAT(Refusal(), ::testing::HasSubstr("there is no such record"));
  Fly("straight_turn", {"timeout=2"});
  EXPECT_EQ(Refusal(), "");
  const auto damaged = [this](const std::string& sql, const std::string& words) {
    const std::string kept = path_ + ".kept";
    std::filesystem::copy_file(path_, kept);
    Execute(sql);
    const std::string refusal = Refusal();
    EXPECT_THAT(refusal, ::testing::StartsWith(path_ + ": ")) << sql;
    EXPECT_THAT(refusal, ::testing::HasSubstr(words)) << sql;
    std::filesystem::rename(kept, path_);
  };
  damaged("UPDATE meta SET value = '1' WHERE key = 'version'", "version 1, this build reads 20");
  damaged("UPDATE meta SET value = 'touchdown trials' WHERE key = 'format'", "no record");
  damaged("DELETE FROM meta WHERE key = 'scenario_yaml'", "lacks scenario_yaml");
  damaged("UPDATE meta SET value = '0.2' WHERE key = 'map_resolution'", "cells of 0.2 m");
  damaged("DROP TABLE belief", "no such table");
  damaged("DELETE FROM replan_input WHERE plan = 3", "replan_input");
  damaged("UPDATE replan_input SET px = NULL WHERE plan = 3", "replan_input lacks a number");
  damaged("UPDATE plan SET status = 'flying' WHERE id = 3", "flying");
  damaged("DELETE FROM control_point WHERE plan = 3 AND i > 1", "control points");
  damaged("UPDATE state_point SET i = 4 WHERE plan = 3 AND i = 3", "state_point");
  damaged("UPDATE map_change SET count = -1 WHERE rowid = 1", "map_change");
  damaged("UPDATE replanner_state SET next_h = -1 WHERE plan = 3", "interval");
  damaged("UPDATE replanner_state SET next_stop_h = -1 WHERE plan = 3", "interval");
  damaged("UPDATE state_point SET curve = 'stop' WHERE plan = 3 AND curve = 'next_stop'",
          "an unknown curve");
}

// Data that a record does not hold must be unchanged since the flight.
TEST_F(Replayed, OtherWaypointsThanInFlightAreRefused) {
  const std::string points = ::testing::TempDir() + "touchdown_replay_waypoints.csv";
  const auto write = [&points](const char* text) { std::ofstream(points) << text; };
  write("t,x,y\n0,0,0\n4,2,0\n30,15,0\n");
  Fly("open",
      {"pad.motion=waypoints", "pad.waypoints=" + points, "pad.prediction=oracle", "timeout=4"});
  EXPECT_EQ(Refusal(), "");
  write("# the same points\nt,x,y\n0,0,0\n4,2,0\n30,15,0\n");
  EXPECT_EQ(Refusal(), "");
  ExpectTheSameBits(ReadRecord(path_, {}, registries_), registries_);
  write("t,x,y\n0,0,0\n4,2,0\n30,15.1,0\n");
  EXPECT_EQ(Refusal(), path_ + ": its pad drove past other points than pad.waypoints, " + points +
                           ", holds now.");
  std::filesystem::remove(points);
  EXPECT_NE(Refusal(), "");
}

TEST_F(Replayed, AnotherVehicleThanInFlightIsRefused) {
  Fly("open", {"timeout=2"});
  Execute("UPDATE meta SET value = 'another' WHERE key = 'vehicle_hash'");
  EXPECT_THAT(Refusal(), ::testing::HasSubstr("its vehicle was another one"));
}

TEST(MapRecorder, RebuildsARollingMap) {
  planning::OccupancyMapOptions options;
  options.size_log2 = {5, 5, 4};
  planning::OccupancyMap map(options), rebuilt(options);
  MapRecorder recorder;
  std::vector<planning::CellState> wanted, got;
  for (int step = 0; step < 12; ++step) {
    const Eigen::Vector3d p(0.7 * step, step < 6 ? 0.3 * step : 3.0 - 0.5 * step, 0.1 * step);
    map.Recentre(p);
    map.MarkFree(p, 0.5);
    map.SetOccupied(p + Eigen::Vector3d(0.6, 0.2, 0.1));
    Apply(recorder.Take(map), &rebuilt);
    EXPECT_EQ(rebuilt.origin(), map.origin());
    map.CopyStates(&wanted);
    rebuilt.CopyStates(&got);
    ASSERT_EQ(got, wanted) << step;
  }
  EXPECT_TRUE(recorder.Take(map).runs.empty());
}

}  // namespace
}  // namespace touchdown::evaluation
