// SPDX-License-Identifier: BSD-3-Clause
// Trials whose process dies or never ends, and trials that fly alone, with backends that are made for these tests.
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/campaign/campaign.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/campaign/sweep_report.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class FaultySolver : public solvers::SolverBackend {
 public:
  explicit FaultySolver(void (*fault)()) : SolverBackend("faulty", {}), fault_(fault) {}
  solvers::Capabilities capabilities() const override { return {}; }

 private:
  void DoPrepare(const solvers::View&) override {}
  void DoSolve(const solvers::View&, const solvers::WarmStart&, const solvers::Stop&,
               solvers::Evaluator*, solvers::SolverResult*) override {
    fault_();
  }
  void (*fault_)();
};

// Where the backend `tells` writes which process solves.
std::string SolvesPath() {
  static const std::string path = testing::TempDir() + "touchdown_solves";
  return path;
}

Registries Faulty() {
  Registries registries = StandardRegistries();
  const auto add = [&](const char* name, void (*fault)()) {
    registries.backends.push_back(
        {name, "faulty", [=] { return std::make_unique<FaultySolver>(fault); }});
  };
  add("aborts", [] { std::abort(); });
  add("leaves", [] { _exit(0); });
  add("throws", [] { throw 1; });
  add("tells", [] {
    std::ofstream(SolvesPath(), std::ios::app) << getpid() << std::endl;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  });
  add("hangs", [] {
    for (;;) pause();
  });
  return registries;
}

Campaign WithBackends(const std::string& backends, int trials, const Registries& registries) {
  SweepOptions options;
  options.scenario_path = FindScenario("open");
  options.overrides = {"timeout=2"};
  options.variations = {Variation::Parse("solver.backend=" + backends, StandardRegistries())};
  options.trials = trials;
  return SweepCampaign(options, registries);
}

TEST(CampaignFaults, ATrialThatDiesIsARowAndNotTheEnd) {
  const Registries registries = Faulty();
  const Campaign campaign = WithBackends("ceres,aborts,leaves,throws", 8, registries);
  CampaignOptions options;
  options.jobs = 2;
  const CampaignResult result =
      RunCampaign(campaign, options, registries, [](const CampaignState&) {});
  ASSERT_EQ(result.rows.size(), 8U);
  for (const SweepRow& row : result.rows) {
    const TrialResult& r = row.result;
    EXPECT_EQ(r.seed, row.trial.seed);
    if (row.trial.index % 4 == 0) {
      EXPECT_EQ(r.outcome, Outcome::kTimeout);
    } else {
      EXPECT_EQ(r.outcome, Outcome::kCrashed) << r.detail;
    }
  }
  EXPECT_EQ(result.rows[1].result.detail, "Its process ended by signal 6 (Aborted).");
  EXPECT_EQ(result.rows[2].result.detail, "Its process ended by exit status 0 without a result.");
  EXPECT_EQ(result.state.succeeded, 0);
  EXPECT_THAT(SweepText(campaign, result.rows),
              AllOf(HasSubstr("6 x crashed"),
                    HasSubstr("touchdown land open --set timeout=2 --set solver.backend=aborts "
                              "--seed " +
                              std::to_string(TrialSeed(1, 1)))));
}

// Each trial is a process. Alone, all that one solves stands together.
TEST(CampaignFaults, TrialsOfMeasuredLatencyAreFlownOneAtATime) {
  const std::string path = SolvesPath();  // the same in all processes that are forked from this one
  std::filesystem::remove(path);
  const Registries registries = Faulty();
  Campaign campaign = WithBackends("tells", 4, registries);
  for (SweepTrial& trial : campaign.trials) trial.scenario.planning.latency.measured = true;
  CampaignOptions options;
  options.jobs = 3;
  RunCampaign(campaign, options, registries, [](const CampaignState&) {});
  std::ifstream solves(path);
  std::vector<std::string> order;
  for (std::string process; std::getline(solves, process);) {
    if (order.empty() || order.back() != process) order.push_back(process);
  }
  EXPECT_EQ(order.size(), 4U);
  std::filesystem::remove(path);
}

TEST(CampaignFaults, ATrialThatNeverEndsIsARowAndNotTheEnd) {
  const Registries registries = Faulty();
  const Campaign campaign = WithBackends("hangs", 2, registries);
  CampaignOptions options;
  options.trial_limit_s = 0.5;
  const CampaignResult result =
      RunCampaign(campaign, options, registries, [](const CampaignState&) {});
  ASSERT_EQ(result.rows.size(), 2U);
  for (const SweepRow& row : result.rows) {
    EXPECT_EQ(row.result.outcome, Outcome::kHung);
    EXPECT_EQ(row.result.detail, "It had not ended after 0.5 s.");
  }
}

}  // namespace
}  // namespace touchdown::evaluation
