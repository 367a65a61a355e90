// SPDX-License-Identifier: BSD-3-Clause
// Begin, end and failures of an export, and its parts. What is in its messages is compared with the record by
// evaluation/mcap/node.
#include "evaluation/mcap/flight_export.h"

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/mcap/flight_scene.h"
#include "evaluation/mcap/occupied_cells.h"
#include "evaluation/mcap/point_cloud.h"
#include "evaluation/mcap/solid.h"
#include "evaluation/record/record.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string SentenceOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

std::string BytesIn(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class FlightExports : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "flight_export";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
    const Scenario scenario = LoadScenario(FindScenario("forest"), {"timeout=1"}, registries_);
    TrialRecord flown;
    const TrialResult result = RunTrial(scenario, scenario.seed, registries_, &flown);
    WriteRecord(record_ = folder_ + "/f.db", scenario, result, flown);
    file_ = folder_ + "/f.mcap";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void Export() { WriteMcap(record_, file_, registries_, {}); }

  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  void Execute(const std::string& sql) {
    SqliteDb(record_, SqliteDb::Mode::kReadWrite).Execute(sql);
  }

  const Registries registries_ = StandardRegistries();
  std::string folder_, record_, file_;
};

TEST_F(FlightExports, RepeatBitByBitAndTellHowFarTheyAre) {
  std::vector<std::pair<int, int>> told;
  WriteMcap(record_, file_, registries_, [&](int done, int all) { told.push_back({done, all}); });
  const std::string bytes = BytesIn(file_);
  EXPECT_EQ(bytes.substr(0, 5), "\x89MCAP");
  ASSERT_GT(told.size(), 100U);
  EXPECT_EQ(told.front().first, 1);
  EXPECT_EQ(told.back(), std::make_pair(static_cast<int>(told.size()), told.back().first));
  Export();  // over it
  EXPECT_EQ(BytesIn(file_), bytes);
}

TEST_F(FlightExports, LeaveNothingWhereTheyAreEnded) {
  struct Ended {};
  EXPECT_THROW(WriteMcap(record_, file_, registries_,
                         [](int done, int) {
                           if (done == 50) throw Ended{};
                         }),
               Ended);
  EXPECT_THAT(Files(), ElementsAre("f.db"));
}

// As on a disk that is full.
class FileSizeScope {
 public:
  explicit FileSizeScope(rlim_t most) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {most, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeScope() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }

 private:
  void (*signal_)(int);
  rlimit before_;
};

TEST_F(FlightExports, SayThatTheDiskIsFullAndStop) {
  int told = 0, all = 0;
  std::string said;
  try {
    const FileSizeScope scope(100000);
    WriteMcap(record_, file_, registries_, [&](int done, int of_all) {
      told = done;
      all = of_all;
    });
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  EXPECT_EQ(said, file_ + ": cannot be written");
  EXPECT_GT(told, 0);
  EXPECT_LT(told, all);
  EXPECT_THAT(Files(), ElementsAre("f.db"));
}

TEST_F(FlightExports, SayWhatIsNoRecord) {
  record_ = folder_ + "/none.db";
  EXPECT_THAT(SentenceOf([&] { Export(); }), HasSubstr("there is no such record"));
  record_ = folder_ + "/f.txt";
  std::ofstream(record_) << "a text";
  EXPECT_THAT(SentenceOf([&] { Export(); }), HasSubstr("f.txt: not a record"));
  record_ = folder_ + "/f.db";
  Execute("UPDATE pad SET cov_xx = NULL WHERE source = 'estimate'");
  EXPECT_THAT(SentenceOf([&] { Export(); }), HasSubstr("f.db: its table pad lacks a number"));
  EXPECT_THAT(Files(), ElementsAre("f.db", "f.txt"));
}

TEST_F(FlightExports, SayThatAStepIsAtNoTimeOfAFlight) {
  Execute("UPDATE replan_input SET t_now = 1e300 WHERE plan = 1");
  EXPECT_EQ(SentenceOf([&] { Export(); }),
            record_ + ": its table replan_input holds the time 1e+300 s where 0 to 601 may stand.");
  Execute("UPDATE replan_input SET t_now = 0.9 - 0.1 * plan WHERE plan < 3");
  EXPECT_EQ(SentenceOf([&] { Export(); }),
            record_ + ": its table replan_input holds times that fall.");
  EXPECT_THAT(Files(), ElementsAre("f.db"));
}

TEST_F(FlightExports, SayThatACurveIsLongerThanAFlight) {
  for (const char* change : {"UPDATE plan SET h = 1e300", "UPDATE plan SET t0 = 1e17"}) {
    SetUp();
    Execute(change);
    EXPECT_EQ(SentenceOf([&] { Export(); }),
              record_ + ": it holds a curve that is no part of a flight.")
        << change;
  }
}

TEST_F(FlightExports, SayThatTextIsNotUtf8) {
  for (const char* change : {"UPDATE event SET text = CAST(x'ff41' AS TEXT)",
                             "UPDATE mode SET mode = CAST(x'ff41' AS TEXT) WHERE t > 0.5"}) {
    SetUp();
    Execute(change);
    EXPECT_EQ(SentenceOf([&] { Export(); }), record_ + ": it holds text that is not UTF-8.")
        << change;
  }
  EXPECT_THAT(Files(), ElementsAre("f.db"));
}

TEST_F(FlightExports, SayThatAMapLeavesItsWindow) {
  Execute("UPDATE map_change SET ix = ix + 100000 WHERE state = 'occupied'");
  EXPECT_THAT(SentenceOf([&] { Export(); }), HasSubstr("cells outside of the map's window"));
  EXPECT_THAT(Files(), ElementsAre("f.db"));
}

TEST_F(FlightExports, NeedAPlaceAndItsName) {
  EXPECT_EQ(SentenceOf([&] { CheckMcap("--mcap", file_); }), "");
  EXPECT_THAT(Files(), ElementsAre("f.db"));
  EXPECT_EQ(SentenceOf([] { CheckMcap("--mcap", "f.bag"); }),
            "--mcap f.bag: the name must end in .mcap.");
  EXPECT_EQ(SentenceOf([&] { CheckMcap("--mcap", folder_ + "/.mcap"); }),
            "--mcap " + folder_ + "/.mcap: a name must stand before .mcap.");
  EXPECT_THAT(SentenceOf([&] { CheckMcap("--mcap", folder_ + "/no/f.mcap"); }),
              HasSubstr("no directory"));
}

TEST(Zones, OfOneTermHaveTheirOwnNames) {
  nlohmann::ordered_json zones = nlohmann::ordered_json::array();
  for (const double x : {1.0, 2.0}) {
    zones.push_back({{"term", "keep_out"},
                     {"shape", "sphere"},
                     {"centre", {x, 0.0, 0.0}},
                     {"size", {1.0, 1.0, 1.0}}});
  }
  const std::vector<NamedSolids> things = ZoneSolids(zones);
  ASSERT_EQ(things.size(), 2U);
  EXPECT_EQ(things[0].name, "zone 1 of keep_out");
  EXPECT_EQ(things[1].name, "zone 2 of keep_out");
  EXPECT_EQ(things[1].solids.at(0).pose.translation().x(), 2.0);
}

MapChange ChangeOf(const planning::CellIndex& origin, std::vector<MapRun> runs) {
  MapChange change;
  change.origin = origin;
  change.runs = std::move(runs);
  return change;
}

TEST(OccupiedCells, FollowTheWindowAndTellWhatIsNew) {
  using planning::CellState;
  OccupiedCells cells({4, 4, 2});
  cells.Apply(ChangeOf({0, 0, 0},
                       {{{0, 1, 0}, 2, CellState::kOccupied}, {{2, 1, 0}, 1, CellState::kFree}}));
  EXPECT_THAT(cells.TakeNew(),
              ElementsAre(OccupiedCells::Cell{0, 1, 0}, OccupiedCells::Cell{0, 1, 1}));
  EXPECT_TRUE(cells.TakeNew().empty());
  // The window moves on by a cell along x: the first one is forgotten. The other one is seen to be free, a third appears.
  cells.Apply(ChangeOf({1, 0, 0}, {{{4, 3, 1}, 1, CellState::kOccupied}}));
  EXPECT_THAT(cells.all(), ElementsAre(OccupiedCells::Cell{0, 1, 1}, OccupiedCells::Cell{1, 3, 4}));
  cells.Apply(ChangeOf({1, 0, 0}, {{{1, 1, 0}, 1, CellState::kFree}}));
  EXPECT_THAT(cells.TakeNew(), ElementsAre(OccupiedCells::Cell{1, 3, 4}));
  EXPECT_THROW(cells.Apply(ChangeOf({1, 0, 0}, {{{4, 3, 1}, 2, CellState::kOccupied}})),
               std::invalid_argument);
  EXPECT_THROW(cells.Apply(ChangeOf({1, 0, 0}, {{{0, 3, 1}, 1, CellState::kOccupied}})),
               std::invalid_argument);
}

Solid SolidOf(Solid::Kind kind) {
  Solid solid;
  solid.kind = kind;
  solid.pose.translate(Eigen::Vector3d(3.0, -2.0, 1.0))
      .rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()));
  solid.size = {1.0, 1.0, 2.0};
  return solid;
}

TEST(Solids, HaveTheirArea) {
  EXPECT_NEAR(AreaOf(SurfaceOf(SolidOf(Solid::Kind::kBox))), 10.0, 1e-12);
  // Polygons lie within the circle.
  const double cylinder = M_PI * (1.0 * 2.0 + 2.0 * 0.25);
  EXPECT_NEAR(AreaOf(SurfaceOf(SolidOf(Solid::Kind::kCylinder))), cylinder, 0.03 * cylinder);
  Solid ball = SolidOf(Solid::Kind::kEllipsoid);
  ball.size.setConstant(2.0);
  EXPECT_NEAR(AreaOf(SurfaceOf(ball)), 4.0 * M_PI, 0.05 * 4.0 * M_PI);
}

TEST(Solids, AreCoveredByPoints) {
  constexpr double kSpacing = 0.1;
  for (const auto kind : {Solid::Kind::kBox, Solid::Kind::kCylinder, Solid::Kind::kEllipsoid}) {
    const Solid solid = SolidOf(kind);
    CloudPoints points;
    AddSurface(solid, kSpacing, &points);
    const TriangleSurface surface = SurfaceOf(solid);
    for (const Eigen::Vector3d& corner : surface.corners) {
      double nearest = 1.0;
      for (const CloudPoint& point : points) {
        nearest = std::min(nearest, (point.p - solid.pose * corner).norm());
      }
      EXPECT_LT(nearest, 2.0 * kSpacing);
    }
    // Points are on the surface: none is farther from the middle than the corners, and none is far
    // inside.
    for (const CloudPoint& point : points) {
      const Eigen::Vector3d p = (solid.pose.inverse() * point.p).cwiseQuotient(0.5 * solid.size);
      const double round = kind == Solid::Kind::kEllipsoid ? p.norm()
                           : kind == Solid::Kind::kCylinder
                               ? std::max(p.head<2>().norm(), std::abs(p.z()))
                               : p.cwiseAbs().maxCoeff();
      EXPECT_LE(round, 1.0 + 1e-9);
      EXPECT_GE(round, 0.94);
    }
    EXPECT_LT(static_cast<double>(points.size()), 4.0 * AreaOf(surface) / (kSpacing * kSpacing));
  }
}

}  // namespace
}  // namespace touchdown::evaluation
