// SPDX-License-Identifier: BSD-3-Clause
// Trials whose process dies or never ends, through backends that are made for it.
#include <unistd.h>

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "touchdown/evaluation/campaign.h"
#include "touchdown/evaluation/sweep.h"
#include "touchdown/evaluation/sweep_report.h"

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

Registries Faulty() {
  Registries registries = StandardRegistries();
  const auto add = [&](const char* name, void (*fault)()) {
    registries.backends.push_back(
        {name, "faulty", [=] { return std::make_unique<FaultySolver>(fault); }});
  };
  add("aborts", [] { std::abort(); });
  add("leaves", [] { _exit(0); });
  add("throws", [] { throw 1; });
  add("hangs", [] {
    for (;;) pause();
  });
  return registries;
}

Campaign WithBackends(const std::string& backends, int trials, const Registries& registries) {
  SweepOptions options;
  options.scenario_path = FindScenario("open");
  options.overrides = {"timeout=2"};
  options.variations = {Variation::Parse("solver.backend=" + backends)};
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
