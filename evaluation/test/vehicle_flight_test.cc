// SPDX-License-Identifier: BSD-3-Clause
// Imported vehicles in the closed loop.
#include <gtest/gtest.h>

#include "evaluation/flight/closed_loop.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

class VehicleFlight : public ::testing::TestWithParam<const char*> {};

TEST_P(VehicleFlight, LandsInTheOpen) {
  const std::string path = std::string(TOUCHDOWN_SOURCE_DIR) + "/sim/models/" + GetParam();
  const Scenario scenario =
      LoadScenario(FindScenario("open"), {"vehicle=" + path}, StandardRegistries());
  const TrialResult result = RunTrial(scenario, 2, StandardRegistries());
  ASSERT_EQ(result.outcome, Outcome::kLanded) << result.detail;
  EXPECT_LT(result.touchdown->error_m, 0.1);
  EXPECT_LT(result.saturation_share, 0.05);
  ASSERT_TRUE(result.time_ratio().has_value());
  EXPECT_GT(*result.time_ratio(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(
    Models, VehicleFlight, ::testing::Values("mini.xml", "carrier.xml"), [](const auto& model) {
      return std::string(model.param).substr(0, std::string(model.param).find('.'));
    });

}  // namespace
}  // namespace touchdown::evaluation
