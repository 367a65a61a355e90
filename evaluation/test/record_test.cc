// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/record/record.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

std::string TempPath(const std::string& name) {
  const std::string path = ::testing::TempDir() + "touchdown_" + name;
  std::filesystem::remove(path);
  return path;
}

TrialRecord SmallRecord() {
  TrialRecord record;
  RecordSample sample;
  sample.t = 0.02;
  sample.vehicle.p_WB = {1.0, 2.0, 1.0 / 3.0};
  sample.mode = "tracking";
  sample.pad_known = true;
  sample.pad_estimate.cov_p << 0.1, 0.02, 0.02, 0.3;
  record.samples = {sample};
  record.events = {{0.01, "mode", "tracking (pad_converged)"}};
  RecordPlan plan;
  plan.request.input.t_now = 0.1;
  plan.request.input.t_start = 0.12;
  plan.result.status = planning::ReplanStatus::kPlanned;
  plan.result.guide_paths = {{{0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}}};
  plan.map_change.runs = {{planning::CellIndex(-1, 2, 3), 4, planning::CellState::kOccupied}};
  record.plans = {plan};
  return record;
}

TEST(Record, HoldsWhatWasWritten) {
  const std::string path = TempPath("record.db");
  Scenario scenario;
  scenario.name = "made_up";
  scenario.cylinders.push_back({{4.0, 5.0}, 0.25, 3.0});
  TrialResult result;
  result.seed = 42;
  result.outcome = Outcome::kTimeout;
  WriteRecord(path, scenario, result, SmallRecord());

  SqliteDb db(path, SqliteDb::Mode::kReadOnly);
  SqliteStatement vehicle = db.Prepare("SELECT t, pz FROM vehicle WHERE source = 'true'");
  ASSERT_TRUE(vehicle.Step());
  EXPECT_EQ(vehicle.Real(0), 0.02);
  EXPECT_EQ(vehicle.Real(1), 1.0 / 3.0);
  EXPECT_FALSE(vehicle.Step());
  SqliteStatement pad = db.Prepare("SELECT cov_xy FROM pad WHERE source = 'estimate'");
  ASSERT_TRUE(pad.Step());
  EXPECT_EQ(pad.Real(0), 0.02);
  SqliteStatement plan = db.Prepare("SELECT status, t_start, points FROM plan");
  ASSERT_TRUE(plan.Step());
  EXPECT_EQ(plan.Text(0), "planned");
  EXPECT_EQ(plan.Real(1), 0.12);
  SqliteStatement points = db.Prepare("SELECT count(*) FROM control_point WHERE plan = 0");
  ASSERT_TRUE(points.Step());
  EXPECT_EQ(points.Integer(0), plan.Integer(2));
  SqliteStatement change = db.Prepare("SELECT ix, count, state FROM map_change");
  ASSERT_TRUE(change.Step());
  EXPECT_EQ(change.Integer(0), -1);
  EXPECT_EQ(change.Integer(1), 4);
  EXPECT_EQ(change.Text(2), "occupied");
  SqliteStatement guide = db.Prepare("SELECT count(*) FROM guide_path");
  ASSERT_TRUE(guide.Step());
  EXPECT_EQ(guide.Integer(0), 2);
  SqliteStatement obstacle = db.Prepare("SELECT kind, cz, radius FROM obstacle");
  ASSERT_TRUE(obstacle.Step());
  EXPECT_EQ(obstacle.Text(0), "cylinder");
  EXPECT_EQ(obstacle.Real(1), 1.5);
  EXPECT_EQ(obstacle.Real(2), 0.25);
  SqliteStatement meta = db.Prepare("SELECT value FROM meta WHERE key = 'scenario_yaml'");
  ASSERT_TRUE(meta.Step());
  EXPECT_EQ(meta.Text(0), DumpScenario(scenario));
  std::filesystem::remove(path);
}

TEST(Record, ReplacesAnOlderOneAndLeavesNothingElse) {
  const std::string directory = ::testing::TempDir() + "touchdown_records";
  std::filesystem::remove_all(directory);
  std::filesystem::create_directories(directory);
  const std::string path = directory + "/landing.db";
  WriteRecord(path, Scenario{}, TrialResult{}, TrialRecord{});
  WriteRecord(path, Scenario{}, TrialResult{}, SmallRecord());
  SqliteDb db(path, SqliteDb::Mode::kReadOnly);
  SqliteStatement count = db.Prepare("SELECT count(*) FROM plan");
  ASSERT_TRUE(count.Step());
  EXPECT_EQ(count.Integer(0), 1);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    files += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(files, 1);
  std::filesystem::remove_all(directory);
}

TEST(AtomicFile, IsGoneUnlessCommitted) {
  const std::string path = TempPath("atomic.txt");
  {
    AtomicFile file(path);
    std::ofstream(file.working_path()) << "half";
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  AtomicFile file(path);
  std::ofstream(file.working_path()) << "whole";
  file.Commit();
  EXPECT_TRUE(std::filesystem::exists(path));
  std::filesystem::remove(path);
}

TEST(SqliteDb, NumbersThatAreNotFiniteAreNull) {
  const std::string path = TempPath("null.db");
  SqliteDb db(path, SqliteDb::Mode::kCreate);
  db.Execute("CREATE TABLE t(a REAL, b TEXT)");
  SqliteStatement insert = db.Prepare("INSERT INTO t VALUES(?, ?)");
  insert.Run(std::numeric_limits<double>::infinity(), "it's");
  insert.Run(std::optional<double>(), "x");
  SqliteStatement select = db.Prepare("SELECT a, b FROM t");
  ASSERT_TRUE(select.Step());
  EXPECT_TRUE(select.IsNull(0));
  EXPECT_EQ(select.Text(1), "it's");
  ASSERT_TRUE(select.Step());
  EXPECT_TRUE(select.IsNull(0));
  std::filesystem::remove(path);
}

TEST(SqliteDb, AnUncommittedTransactionLeavesNoTrace) {
  const std::string path = TempPath("rollback.db");
  SqliteDb db(path, SqliteDb::Mode::kCreate);
  db.Execute("CREATE TABLE t(a)");
  {
    SqliteTransaction transaction(db);
    db.Execute("INSERT INTO t VALUES(1)");
  }
  SqliteStatement count = db.Prepare("SELECT count(*) FROM t");
  ASSERT_TRUE(count.Step());
  EXPECT_EQ(count.Integer(0), 0);
  std::filesystem::remove(path);
}

TEST(SqliteDb, SaysWhatIsWrong) {
  EXPECT_THROW(SqliteDb("/no/such/directory/x.db", SqliteDb::Mode::kReadOnly), SqliteError);
  const std::string path = TempPath("wrong.db");
  SqliteDb db(path, SqliteDb::Mode::kCreate);
  EXPECT_THROW(db.Execute("SELEKT 1"), SqliteError);
  EXPECT_THROW(db.Prepare("SELECT * FROM nothing"), SqliteError);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace touchdown::evaluation
