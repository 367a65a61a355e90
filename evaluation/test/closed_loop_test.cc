// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/closed_loop.h"

#include <gtest/gtest.h>

#include "touchdown/evaluation/trial_json.h"

namespace touchdown::evaluation {
namespace {

Scenario Shipped(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return LoadScenario(FindScenario(name), overrides, {"ceres"});
}

std::string Deterministic(const Scenario& scenario, const TrialResult& result) {
  nlohmann::ordered_json json = LandJson(scenario, result);
  json.erase("wall_clock");
  return json.dump();
}

TEST(ClosedLoop, LandsInThePapersFirstCase) {
  const Scenario scenario = Shipped("straight_turn");
  TrialRecord record;
  const TrialResult result = RunTrial(scenario, 1, solvers::StandardBackends(), &record);
  ASSERT_EQ(result.outcome, Outcome::kLanded) << result.detail;
  EXPECT_LE(result.touchdown->t, 15.0);
  EXPECT_LE(result.touchdown->error_m, 0.15);
  EXPECT_GT(*result.min_clearance_m, 0.0);
  EXPECT_LT(*result.mean_abs_error_x_m, 0.226);
  EXPECT_LT(*result.mean_abs_error_y_m, 0.263);
  // No plan was flown without its certificate.
  for (const RecordPlan& plan : record.plans) {
    if (plan.status == planning::ReplanStatus::kPlanned) {
      EXPECT_TRUE(plan.certificate.passed());
      EXPECT_LE(plan.certificate.endpoint_position_residual, 1e-9);
      EXPECT_LE(plan.certificate.endpoint_velocity_residual, 1e-9);
    }
  }
}

TEST(ClosedLoop, TheSameSeedGivesTheSameBitsRecordedOrNot) {
  const Scenario scenario = Shipped("straight_turn", {"timeout=4"});
  TrialRecord record;
  const TrialResult a = RunTrial(scenario, 3, solvers::StandardBackends());
  const TrialResult b = RunTrial(scenario, 3, solvers::StandardBackends(), &record);
  EXPECT_EQ(Deterministic(scenario, a), Deterministic(scenario, b));
  const TrialResult other = RunTrial(scenario, 4, solvers::StandardBackends());
  EXPECT_NE(Deterministic(scenario, a), Deterministic(scenario, other));
}

TEST(ClosedLoop, DescentNoneFollowsAndNeverLands) {
  const Scenario scenario = Shipped("open", {"descent=none", "timeout=12"});
  TrialRecord record;
  const TrialResult result = RunTrial(scenario, 1, solvers::StandardBackends(), &record);
  EXPECT_EQ(result.outcome, Outcome::kTimeout);
  const RecordSample& last = record.samples.back();
  EXPECT_LT((last.vehicle.p_WB - last.pad.p_WP).head<2>().norm(), 0.2);
  EXPECT_GT(last.vehicle.p_WB.z() - last.pad.p_WP.z(), 1.0);
}

TEST(ClosedLoop, AnOraclePredictionAndThePapersPartsLandToo) {
  for (const char* choice : {"pad.prediction=oracle", "pad.prediction=paper", "estimator.pad=paper",
                             "controller=paper"}) {
    const Scenario scenario = Shipped("open", {choice});
    const TrialResult result = RunTrial(scenario, 1, solvers::StandardBackends());
    EXPECT_EQ(result.outcome, Outcome::kLanded) << choice << ": " << result.detail;
  }
}

}  // namespace
}  // namespace touchdown::evaluation
