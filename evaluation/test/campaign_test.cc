// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/campaign.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/campaign/sweep_report.h"
#include "evaluation/campaign/trial_merge.h"
#include "evaluation/campaign/trial_store.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Registries kRegistries = StandardRegistries();

// Between the buildings: search, pairs and the map take part.
Campaign Short(int trials, const std::string& timeout = "2") {
  SweepOptions options;
  options.scenario_path = FindScenario("straight_turn");
  options.overrides = {"start.position_spread=[1, 1, 0]", "start.yaw_random=true",
                       "timeout=" + timeout};
  options.variations = {Variation::Parse("controller=geometric,paper", StandardRegistries()),
                        Variation::Parse("gps.sigma=0.1..0.5", StandardRegistries())};
  options.trials = trials;
  options.seed = 7;
  return SweepCampaign(options, kRegistries);
}

CampaignResult Fly(const Campaign& campaign, const CampaignOptions& options,
                   const Registries& registries = kRegistries) {
  return RunCampaign(campaign, options, registries, [](const CampaignState&) {});
}

CampaignOptions To(const std::string& db, int jobs = 1, Shard shard = {}) {
  CampaignOptions options;
  options.db = db;
  options.jobs = jobs;
  options.shard = shard;
  return options;
}

/// A folder of this test's own.
class CampaignFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string At(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) / "campaign";
};

/// Everything that does not depend on the clock, in the order in which it is stored.
std::string Tables(const std::string& path) {
  SqliteDb db(path, SqliteDb::Mode::kReadOnly);
  std::string text;
  for (const std::string table :
       {"planned", "variation", "varied_key", "trial", "cell", "cell_value", "manifest"}) {
    SqliteStatement rows = db.Prepare("SELECT * FROM " + table + " ORDER BY rowid");
    while (rows.Step()) {
      text += table;
      for (const SqlValue& value : rows.Row()) {
        text += "|";
        if (const auto* number = std::get_if<double>(&value)) text += fmt::format("{}", *number);
        if (const auto* whole = std::get_if<std::int64_t>(&value))
          text += fmt::format("{}", *whole);
        if (const auto* word = std::get_if<std::string>(&value)) text += *word;
      }
      text += "\n";
    }
  }
  return text;
}

std::string Report(const Campaign& campaign, const CampaignResult& result) {
  nlohmann::ordered_json json = SweepJson(campaign, result.rows);
  json.erase("wall_clock");
  return json.dump();
}

TEST(Shard, IsANumberOfANumber) {
  EXPECT_EQ(Shard::Parse("2/3").ToString(), "2/3");
  EXPECT_TRUE(Shard::Parse("2/3").Takes(4));
  EXPECT_FALSE(Shard::Parse("2/3").Takes(3));
  for (const char* wrong : {"", "1", "0/2", "3/2", "1/2/3", "-1/2", "a/b", "1/", " 1/2"}) {
    EXPECT_THROW(Shard::Parse(wrong), BadInput) << wrong;
  }
}

TEST_F(CampaignFiles, OneAndTwoJobsGiveTheSameTables) {
  const Campaign campaign = Short(5);
  const CampaignResult one = Fly(campaign, To(At("one.db")));
  const CampaignResult two = Fly(campaign, To(At("two.db"), 2));
  EXPECT_EQ(one.rows.size(), 5U);
  EXPECT_EQ(Tables(At("one.db")), Tables(At("two.db")));
  EXPECT_EQ(Report(campaign, one), Report(campaign, two));
  EXPECT_EQ(Report(campaign, one), Report(campaign, Fly(campaign, To(""))));
}

TEST_F(CampaignFiles, AFinishedOneIsReadAndNotFlown) {
  const Campaign campaign = Short(2);
  const CampaignResult first = Fly(campaign, To(At("a.db")));
  const CampaignResult again = Fly(campaign, To(At("a.db")));
  EXPECT_EQ(again.state.resumed, 2);
  // With its wall clock: the replans' single times are kept too.
  EXPECT_EQ(SweepJson(campaign, first.rows).dump(), SweepJson(campaign, again.rows).dump());
  EXPECT_EQ(SweepText(campaign, first.rows), SweepText(campaign, again.rows));
}

TEST_F(CampaignFiles, WhatIsMissingIsFlownAndNothingElse) {
  const Campaign campaign = Short(4);
  const CampaignResult whole = Fly(campaign, To(At("whole.db")));
  {
    TrialStore store(At("part.db"), campaign, {});
    store.Add(2, whole.rows[2].result);
  }
  std::vector<int> flown;
  const CampaignResult rest =
      RunCampaign(campaign, To(At("part.db"), 2), kRegistries,
                  [&](const CampaignState& state) { flown.push_back(state.flown); });
  EXPECT_EQ(flown, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(rest.state.resumed, 1);
  EXPECT_EQ(Tables(At("part.db")), Tables(At("whole.db")));
}

TEST_F(CampaignFiles, AnotherOneIsRefusedAndSaysWhatDiffers) {
  const Campaign campaign = Short(2);
  { TrialStore store(At("a.db"), campaign, {}); }
  const auto refused = [&](const Campaign& other, const Shard& shard, const char* words) {
    EXPECT_THAT([&] { TrialStore(At("a.db"), other, shard); },
                ThrowsMessage<BadInput>(HasSubstr(words)));
  };
  refused(Short(3), {}, "its trials is 2, not 3");
  refused(campaign, {1, 2}, "its shard is 1/1, not 1/2");
  refused(Short(2, "3"), {}, "its set is");
  Campaign other = campaign;
  other.seed = 8;
  refused(other, {}, "its sweep_seed is 7, not 8");
  other = campaign;
  other.name = "study";
  refused(other, {}, "its campaign is sweep, not study");
  other = campaign;
  other.trials[0].scenario.timeout = 9.0;
  refused(other, {}, "its scenario says \"timeout: 2\" where this one says \"timeout: 9\"");
  other = campaign;
  other.trials[1].scenario.timeout = 9.0;
  refused(other, {}, "its trials are others");
  other = campaign;
  for (SweepTrial& trial : other.trials) trial.scenario.description = "Said otherwise";
  EXPECT_EQ(CampaignHash(other), CampaignHash(campaign));
  EXPECT_NO_THROW(TrialStore(At("a.db"), other, {}));
}

TEST_F(CampaignFiles, AnotherBuildIsRefused) {
  const Campaign campaign = Short(1);
  { TrialStore store(At("a.db"), campaign, {}); }
  {
    SqliteDb db(At("a.db"), SqliteDb::Mode::kReadWrite);
    db.Execute("UPDATE manifest SET value = 'x' WHERE key IN ('cpu', 'build_hash')");
  }
  EXPECT_THAT([&] { TrialStore(At("a.db"), campaign, {}); },
              ThrowsMessage<BadInput>(HasSubstr("its cpu is x, not ")));
}

TEST_F(CampaignFiles, AFileThatIsNoneIsRefused) {
  const Campaign campaign = Short(1);
  { SqliteDb(At("a.db"), SqliteDb::Mode::kCreate).Execute("CREATE TABLE t(x)"); }
  EXPECT_THAT([&] { TrialStore(At("a.db"), campaign, {}); },
              ThrowsMessage<BadInput>(HasSubstr("no file of trials")));
}

TEST_F(CampaignFiles, TwoWritersAreOneTooMany) {
  const Campaign campaign = Short(1);
  const TrialStore store(At("a.db"), campaign, {});
  EXPECT_THAT([&] { TrialStore(At("a.db"), campaign, {}); },
              ThrowsMessage<BadInput>(HasSubstr("another process")));
}

TEST_F(CampaignFiles, OthersReadWhileItIsWritten) {
  const Campaign campaign = Short(3);
  std::vector<int> seen;
  RunCampaign(campaign, To(At("a.db")), kRegistries, [&](const CampaignState& state) {
    SqliteDb reader(At("a.db"), SqliteDb::Mode::kReadOnly);
    seen.push_back(static_cast<int>(ReadTrials(reader, true).size()));
    SqliteStatement cells = reader.Prepare("SELECT sum(trials) FROM cell");
    cells.Step();
    EXPECT_EQ(cells.Integer(0), state.flown);
  });
  EXPECT_EQ(seen, (std::vector<int>{0, 1, 2, 3}));
}

TEST_F(CampaignFiles, ShardsMergedAreAsIfOneProcessHadFlownAll) {
  const Campaign campaign = Short(5);
  const CampaignResult whole = Fly(campaign, To(At("whole.db")));
  EXPECT_EQ(Fly(campaign, To(At("1.db"), 2, {1, 2})).rows.size(), 3U);
  EXPECT_EQ(Fly(campaign, To(At("2.db"), 1, {2, 2})).rows.size(), 2U);
  const MergedTrials merged = MergeTrials(At("out.db"), {At("2.db"), At("1.db")}, false);
  EXPECT_EQ(merged.flown, 5);
  EXPECT_EQ(merged.planned, 5);
  EXPECT_EQ(Tables(At("out.db")), Tables(At("whole.db")));
  const CampaignResult read = Fly(campaign, To(At("out.db")));
  EXPECT_EQ(read.state.resumed, 5);
  EXPECT_EQ(Report(campaign, read), Report(campaign, whole));
}

TEST_F(CampaignFiles, AMergeIsRefusedWhereTrialsDoNotFit) {
  const Campaign campaign = Short(4);
  const CampaignResult whole = Fly(campaign, To(""));
  const auto write = [&](const char* name, const Campaign& of, const Shard& shard,
                         std::vector<int> trials) {
    TrialStore store(At(name), of, shard);
    for (const int i : trials) store.Add(i, whole.rows[static_cast<std::size_t>(i)].result);
    return At(name);
  };
  Campaign another = campaign;
  another.seed = 8;
  const std::string a = write("a.db", campaign, {1, 2}, {0, 2}),
                    b = write("b.db", campaign, {2, 2}, {1}),
                    c = write("c.db", campaign, {1, 4}, {0}),
                    d = write("d.db", another, {2, 2}, {1, 3});
  const auto refused = [&](const std::vector<std::string>& files, bool partial,
                           const std::string& words) {
    EXPECT_THAT([&] { MergeTrials(At("out.db"), files, partial); },
                ThrowsMessage<BadInput>(HasSubstr(words)));
    EXPECT_FALSE(std::filesystem::exists(At("out.db")));
  };
  refused({a, b}, false, "1 of 4 trials are in none of the files, the first of them is trial 3");
  refused({a, c}, true, c + ": trial 0 is in " + a);
  refused({a, d}, true, d + ": it does not belong to " + a + ": its sweep_seed is 8, not 7");
  refused({a, At("none.db")}, true, "none.db");
  // Missing trials can be flown afterwards.
  EXPECT_EQ(MergeTrials(At("out.db"), {a, b}, true).flown, 3);
  EXPECT_THAT(
      [&] {
        MergeTrials(At("out.db"), {a, b}, true);
      },
      ThrowsMessage<BadInput>(HasSubstr("exists")));
  EXPECT_EQ(Fly(campaign, To(At("out.db"))).state.resumed, 3);
  Fly(campaign, To(At("whole.db")));
  EXPECT_EQ(Tables(At("out.db")), Tables(At("whole.db")));
}

TEST_F(CampaignFiles, LostTrialsAreFlownAgainOnlyWhenAsked) {
  const Campaign campaign = Short(4);
  Campaign faulty = Short(4);
  faulty.trials[1].scenario.solver.backend = "none";
  const CampaignResult first = Fly(faulty, To(""));
  ASSERT_EQ(first.rows[1].result.outcome, Outcome::kError);
  WriteTrials(At("a.db"), campaign, first.rows);
  EXPECT_EQ(Fly(campaign, To(At("a.db"))).state.resumed, 4);
  CampaignOptions again = To(At("a.db"));
  again.retry = true;
  const CampaignResult repaired = Fly(campaign, again);
  EXPECT_EQ(repaired.state.resumed, 3);
  EXPECT_NE(repaired.rows[1].result.outcome, Outcome::kError);
  Fly(campaign, To(At("whole.db")));
  EXPECT_EQ(Tables(At("a.db")), Tables(At("whole.db")));
}

// A merge reads a file as of one moment. Otherwise it could have written this.
TEST_F(CampaignFiles, ATrialWithoutItsTimingIsNoResult) {
  Fly(Short(2), To(At("a.db")));
  SqliteDb db(At("a.db"), SqliteDb::Mode::kReadWrite);
  db.Execute("DELETE FROM timing WHERE trial = 0");
  EXPECT_THAT([&] { ReadTrials(db, false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("trial 0 has no timing")));
}

TEST_F(CampaignFiles, ATrialThatThrowsIsARowAndNotTheEnd) {
  Campaign campaign = Short(3);
  campaign.trials[1].scenario.solver.backend = "none";
  const CampaignResult result = Fly(campaign, To("", 2));
  ASSERT_EQ(result.rows.size(), 3U);
  EXPECT_EQ(result.rows[1].result.outcome, Outcome::kError);
  EXPECT_FALSE(result.rows[1].result.detail.empty());
  EXPECT_NE(result.rows[0].result.outcome, Outcome::kError);
  EXPECT_THAT(SweepText(campaign, result.rows), HasSubstr("1 x error"));
}

TEST_F(CampaignFiles, TrialsOfMeasuredLatencyWaitUntilTheOthersAreFlown) {
  Campaign campaign = Short(4);
  for (const std::size_t i : {0U, 2U}) {
    campaign.trials[i].scenario.planning.latency.measured = true;
    EXPECT_TRUE(campaign.trials[i].FliesAlone());
  }
  const auto halfway = [](const CampaignState& state) {
    if (state.flown == 2) throw std::runtime_error("far enough");
  };
  EXPECT_THROW(RunCampaign(campaign, To(At("a.db"), 2), kRegistries, halfway), std::runtime_error);
  {
    const TrialStore store(At("a.db"), campaign, {});
    for (int i = 0; i < 4; ++i) EXPECT_EQ(store.Holds(i), i % 2 == 1) << i;
  }
  const CampaignResult whole = Fly(campaign, To(At("a.db"), 2));
  EXPECT_EQ(whole.state.resumed, 2);
  EXPECT_EQ(whole.state.flown, 4);
}

}  // namespace
}  // namespace touchdown::evaluation
