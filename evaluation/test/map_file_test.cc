// SPDX-License-Identifier: BSD-3-Clause
// Maps as files: saved after a flight, known before the next one, refused with a sentence.

#include "evaluation/base/map_file.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/octomap.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/sqlite_db.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/plan_report.h"
#include "evaluation/record/record_reader.h"
#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/evaluation/program/program.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Ran {
  int status = 0;
  std::string out, err;
};

Ran Call(std::vector<const char*> arguments) {
  const Registries registries = StandardRegistries();
  arguments.insert(arguments.begin(), "touchdown");
  Ran ran;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  ran.status = RunProgram(static_cast<int>(arguments.size()), arguments.data(), registries);
  ran.out = ::testing::internal::GetCapturedStdout();
  ran.err = ::testing::internal::GetCapturedStderr();
  return ran;
}

/// A directory of its own, gone with the test.
class MapFile : public ::testing::Test {
 protected:
  MapFile() { fs::create_directory(directory_); }
  ~MapFile() override { fs::remove_all(directory_); }
  std::string Path(const std::string& name) const { return (directory_ / name).string(); }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

 private:
  fs::path directory_ = fs::path(::testing::TempDir()) / "map";
};

using CellSet = std::set<std::array<int, 3>>;

std::array<int, 3> KeyOf(const planning::CellIndex& cell) { return {cell.x(), cell.y(), cell.z()}; }

/// Cells that were observed free at any step.
CellSet SeenFree(const TrialRecord& record) {
  CellSet seen;
  for (const RecordPlan& plan : record.plans) {
    for (const MapRun& run : plan.map_change.runs) {
      for (int i = 0; run.state == planning::CellState::kFree && i < run.count; ++i) {
        seen.insert(KeyOf(run.cell + i * planning::CellIndex::UnitX()));
      }
    }
  }
  return seen;
}

/// How far the body reaches at least, whatever its tilt [m].
const std::array<Eigen::Vector3d, 6> kSidesOfBody = {
    {{0.15, 0, 0}, {-0.15, 0, 0}, {0, 0.15, 0}, {0, -0.15, 0}, {0, 0, 0.05}, {0, 0, -0.05}}};

Scenario StraightTurn(const std::vector<std::string>& overrides) {
  return LoadScenario(FindScenario("straight_turn"), overrides, StandardRegistries());
}

TEST_F(MapFile, WhatWasSeenIsKnownInTheNextFlight) {
  for (const char* name : {"seen.bt", "seen.ot"}) {
    const std::string path = Path(name);
    EXPECT_EQ(Call({"land", "straight_turn", "--save-map", path.c_str()}).status, 0);
    TrialRecord record;
    const Scenario scenario = StraightTurn({"map.prior=" + path});
    const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
    EXPECT_EQ(result.outcome, Outcome::kLanded) << result.detail;
    // Before anything can be seen, the wall behind the first box is known.
    planning::PersistentMap seen{planning::OccupancyMapOptions{}};
    ReadMapFile(path, &seen);
    int known = 0;
    for (const MapRun& run : record.plans.front().map_change.runs) {
      for (int i = 0; i < run.count && run.state == planning::CellState::kOccupied; ++i) {
        const planning::CellIndex cell = run.cell + i * planning::CellIndex::UnitX();
        known += cell.x() > 100 && seen.IsOccupied(cell);
      }
    }
    EXPECT_GT(known, 20) << name;
    fs::remove(path);
  }
  EXPECT_THAT(Files(), IsEmpty());  // nothing is left beside
}

// A map that octomap made: free space with a wall across the straight line to the pad, where the world has none. It
// guides the search but does not prove free space (docs/safety.md). With a single depth image the vehicle stays in what
// that image showed; with a camera it lands.
TEST_F(MapFile, AForeignMapIsNoObservation) {
  octomap::OcTree tree(0.1);
  for (int x = -20; x < 90; ++x) {
    for (int y = -60; y < 60; ++y) {
      for (int z = 0; z < 55; ++z) {
        const bool wall = std::abs(x - 30) < 2 && std::abs(y) < 25;
        tree.updateNode(0.1 * x + 0.05, 0.1 * y + 0.05, 0.1 * z + 0.05, wall, true);
      }
    }
  }
  tree.updateInnerOccupancy();
  const std::string path = Path("wall.bt");
  ASSERT_TRUE(tree.writeBinary(path));
  for (const bool sees : {false, true}) {
    const Scenario scenario =
        LoadScenario(FindScenario("open"),
                     {"map.prior=" + path, sees ? "depth.rate=10" : "depth.rate=0.001",
                      "pad.motion=static", "pad.start=[6, 0]", "planning.ceiling=4", "timeout=20"},
                     StandardRegistries());
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
    EXPECT_EQ(result.landed(), sees) << result.detail;
    if (sees) continue;
    const CellSet seen = SeenFree(record);
    const planning::OccupancyMap cells{planning::OccupancyMapOptions{}};
    for (const RecordSample& sample : record.samples) {
      for (const Eigen::Vector3d& side : kSidesOfBody) {
        const Eigen::Vector3d p_W = sample.vehicle.p_WB + side;
        ASSERT_TRUE(seen.contains(KeyOf(cells.CellOf(p_W)))) << p_W.transpose();
      }
    }
  }
}

TEST_F(MapFile, AMapThatCannotBeUsedIsBadInput) {
  const auto refuses = [](const std::string& path, const std::string& why) {
    const std::string key = "map.prior=" + path;
    const Ran ran = Call({"land", "open", "--set", key.c_str()});
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.err, AllOf(HasSubstr("map.prior"), HasSubstr(path), HasSubstr(why)));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
  };
  refuses(Path("nowhere.bt"), "cannot be read (No such file");
  refuses(Path(""), "it is a directory");
  std::ofstream(Path("text.bt")) << "Hello.\n";
  refuses(Path("text.bt"), "it is no OctoMap file");
  octomap::OcTree coarse(99.97);
  coarse.updateNode(1.0, 1.0, 1.0, true);
  ASSERT_TRUE(coarse.write(Path("coarse.ot")));
  refuses(Path("coarse.ot"), "more than five million leaves; crop the file");
}

constexpr const char* kBeliefs = TOUCHDOWN_SOURCE_DIR "/docs/examples/worlds/";

// Cells of 0.1 m that wall_gone.bt holds occupied: two walls of 0.2 m, the lowest cells are ground.
constexpr int kGoneWall = 2 * 60 * 29;
constexpr int kStandingWall = 2 * 40 * 29;

Scenario Believing(const std::string& world, const std::string& belief) {
  return LoadScenario(kBeliefs + world + ".yaml", {"map.prior=" + (kBeliefs + belief + ".bt")},
                      StandardRegistries());
}

TEST_F(MapFile, AWallThatDoesNotStandIsFoundGone) {
  TrialRecord record;
  const TrialResult result =
      RunTrial(Believing("wall_gone", "wall_gone"), 1, StandardRegistries(), &record);
  EXPECT_TRUE(result.landed()) << result.detail;
  ASSERT_TRUE(result.prior.has_value());
  EXPECT_EQ(result.prior->occupied, kGoneWall + kStandingWall);
  EXPECT_GT(result.prior->gone, 500);
  EXPECT_GE(result.prior->looked_at, result.prior->gone);
  EXPECT_EQ(result.prior->appeared, 0);
  ASSERT_EQ(std::ssize(record.prior.gone), result.prior->gone);
  for (const planning::CellIndex& cell : record.prior.gone) {
    EXPECT_TRUE(cell.x() == 80 || cell.x() == 81) << cell.transpose();
  }
  std::int64_t drawn = 0;  // both walls, with what of their cubes is ground
  for (const planning::CellCube& cube : record.prior.occupied) {
    drawn += std::int64_t{cube.side} * cube.side * cube.side;
  }
  EXPECT_EQ(drawn, (kGoneWall + kStandingWall) / 29 * 30);
}

TEST_F(MapFile, AWallThatThePriorLacksIsFoundNew) {
  TrialRecord record;
  const TrialResult result =
      RunTrial(Believing("wall_new", "wall_new"), 1, StandardRegistries(), &record);
  EXPECT_TRUE(result.landed()) << result.detail;
  ASSERT_TRUE(result.prior.has_value());
  EXPECT_EQ(result.prior->occupied, kStandingWall);
  EXPECT_EQ(result.prior->gone, 0);
  EXPECT_GT(result.prior->appeared, 500);
  ASSERT_EQ(std::ssize(record.prior.appeared), result.prior->appeared);
  for (const planning::CellIndex& cell : record.prior.appeared) {
    EXPECT_TRUE(cell.x() >= 79 && cell.x() <= 82) << cell.transpose();
  }
}

TEST_F(MapFile, APriorThatAgreesIsNotContradicted) {
  const TrialResult result =
      RunTrial(Believing("wall_new", "wall_gone"), 1, StandardRegistries(), nullptr);
  EXPECT_TRUE(result.landed()) << result.detail;
  ASSERT_TRUE(result.prior.has_value());
  EXPECT_GT(result.prior->looked_at, 500);
  EXPECT_EQ(result.prior->gone, 0);
  EXPECT_EQ(result.prior->appeared, 0);
}

std::string InRecord(const std::string& path, const std::string& query) {
  SqliteDb db(path, SqliteDb::Mode::kReadOnly);
  SqliteStatement statement = db.Prepare(query);
  return statement.Step() ? statement.Text(0) : "none";
}

TEST_F(MapFile, WhatBecameOfThePriorIsSaidAndKept) {
  const std::string scenario = std::string(kBeliefs) + "wall_gone.yaml";
  const std::string prior = std::string("map.prior=") + kBeliefs + "wall_gone.bt";
  const std::string path = Path("flight.db");
  const Ran said =
      Call({"land", scenario.c_str(), "--set", prior.c_str(), "--record", path.c_str()});
  EXPECT_EQ(said.status, 0) << said.err;
  const auto kept = nlohmann::json::parse(InRecord(
      path, "SELECT json_extract(value, '$.map_prior') FROM meta WHERE key = 'result_json'"));
  EXPECT_EQ(kept.at("occupied_cells"), kGoneWall + kStandingWall);
  EXPECT_EQ(
      InRecord(path, "SELECT CAST(length(cubes) / 16 AS TEXT) FROM prior WHERE state = 'gone'"),
      kept.at("gone_cells").dump());
  EXPECT_EQ(InRecord(path, "SELECT CAST(length(cubes) AS TEXT) FROM prior WHERE state = 'new'"),
            "none");
  EXPECT_THAT(said.out, HasSubstr(" of its 5,800 occupied cells were looked at; "));
  EXPECT_THAT(said.out, HasSubstr("\nwarning: "));
  // The picture of a step has what the flight knew before it.
  const Registries registries = StandardRegistries();
  const RecordedFlight flight = ReadRecord(path, {}, registries);
  EXPECT_EQ(
      InRecord(path, "SELECT CAST(length(cubes) / 16 AS TEXT) FROM prior WHERE state = 'occupied'"),
      std::to_string(flight.prior.size()));
  const nlohmann::ordered_json step = PlanJson(SolveStep(flight, 0, registries), true);
  ASSERT_EQ(step.at("prior").size(), flight.prior.size());
  const planning::CellCube& last = flight.prior.back();
  EXPECT_EQ(step.at("prior").back(),
            nlohmann::ordered_json({last.low.x(), last.low.y(), last.low.z(), last.side}));
  EXPECT_GT(last.side, 0);
  const Ran json = Call({"land", scenario.c_str(), "--set", prior.c_str(), "--json"});
  EXPECT_EQ(nlohmann::json::parse(json.out).at("map_prior"), kept);
  const Ran without = Call({"land", scenario.c_str(), "--set", "map.prior=none"});
  EXPECT_THAT(without.out, ::testing::Not(HasSubstr("map.prior")));
}

TEST_F(MapFile, APlaceForNoMapIsBadInputBeforeTheFlight) {
  const Ran unnamed = Call({"land", "open", "--save-map", Path("map.txt").c_str()});
  EXPECT_EQ(unnamed.status, 2);
  EXPECT_THAT(unnamed.err, HasSubstr("the name must end in .bt or .ot"));
  const Ran nowhere = Call({"land", "open", "--save-map", Path("no/map.bt").c_str()});
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("there is no directory"));
  EXPECT_THAT(Files(), IsEmpty());
}

}  // namespace
}  // namespace touchdown::evaluation
