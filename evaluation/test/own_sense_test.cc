// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/own_sense.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/flight/closed_loop.h"
#include "evaluation/flight/onboard_setup.h"
#include "evaluation/record/trial_json.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using Overrides = std::vector<std::string>;

Scenario Shipped(const std::string& name, const Overrides& overrides) {
  return LoadScenario(FindScenario(name), overrides, StandardRegistries());
}

std::string Deterministic(const Scenario& scenario, const TrialResult& result) {
  nlohmann::ordered_json json = LandJson(scenario, result);
  json.erase("wall_clock");
  return json.dump();
}

estimation::VehicleState Start() {
  estimation::VehicleState start;
  start.p_WB = {1.0, 2.0, 3.0};
  start.q_WB = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
  return start;
}

// A vehicle that stands at its start, told of itself for `seconds`; `look` is called after each step.
template <typename Look>
void Stand(const Scenario& scenario, double seconds, Look&& look) {
  const estimation::VehicleModel model = sim::LoadVehicleModel(VehicleMjcf(scenario));
  const Registries registries = StandardRegistries();
  const auto course = PadCourseOf(scenario, registries, 0.0, 1);
  control::Onboard onboard = MakeOnboard(scenario, model, course, registries);
  OwnSense own(scenario, 3);
  own.Hover(Start(), 0.002, &onboard);
  onboard.Begin(0.0, Eigen::Vector4d::Constant(0.25 * model.HoverThrust()));
  estimation::VehicleState truth = Start();
  for (int k = 0; k <= std::lround(seconds / 0.002); ++k) {
    truth.t = 0.002 * k;
    own.Sense(truth, &onboard);
    onboard.Step(truth.t);
    look(k, truth, onboard);
  }
}

TEST(OwnSense, TheTruthIsKnownExactly) {
  Stand(Shipped("open", {}), 0.1, [](int, const auto& truth, const control::Onboard& onboard) {
    EXPECT_EQ(onboard.own().t, truth.t);
    EXPECT_EQ(onboard.own().p_WB, truth.p_WB);
    EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kGood);
  });
}

TEST(OwnSense, TheDefaultsAreThoseOfTheSensors) {
  const sim::OwnSensorRigConfig config = OwnSensorsOf(Scenario{});
  const sim::OwnSensorRigConfig defaults;
  const auto same = [](const sim::OwnSensorConfig& a, const sim::OwnSensorConfig& b) {
    EXPECT_EQ(a.rate_hz, b.rate_hz);
    EXPECT_NEAR(a.sigma, b.sigma, 1e-4);  // 2 deg, 0.035 rad
    EXPECT_EQ(a.drift_sigma, b.drift_sigma);
    EXPECT_EQ(a.latency_ms, b.latency_ms);
  };
  same(config.sensors.gps.sensor, defaults.sensors.gps.sensor);
  same(config.sensors.odometry, defaults.sensors.odometry);
  same(config.sensors.height, defaults.sensors.height);
  same(config.sensors.heading, defaults.sensors.heading);
  EXPECT_EQ(config.sensors.gps.outage_length, 0.0);
  EXPECT_EQ(config.imu.gyro_noise, defaults.imu.gyro_noise);
}

// The estimate at a past time and its uncertainty, with and without fixes.
TEST(OwnSense, AnOutageIsTold) {
  const Scenario scenario = Shipped("open", {"own_state=estimated", "own.gps.outage=[1, 4]"});
  Stand(scenario, 5.0, [](int k, const auto& truth, const control::Onboard& onboard) {
    ASSERT_EQ(onboard.own().t, truth.t);
    if (k == 1900) {
      EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kOutage);
    }
    if (k < 2500) return;
    EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kGood);
    EXPECT_LT((onboard.own().p_WB - truth.p_WB).norm(), 0.1);
    EXPECT_NEAR(onboard.OwnAt(4.7).t, 4.7, 1e-9);
    EXPECT_LT((onboard.OwnAt(4.7).p_WB - truth.p_WB).norm(), 0.1);
  });
}

TEST(OwnFlight, BothOfThePapersCasesLandByTheEstimateAndRepeatBitByBit) {
  for (const char* name : {"straight_turn", "circle"}) {
    const Scenario scenario = Shipped(name, {"own_state=estimated", "gps.sigma=0.5"});
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
    EXPECT_TRUE(result.landed()) << name << ": " << result.detail;
    EXPECT_LT(result.touchdown->error_m, 0.15) << name;
    ASSERT_TRUE(result.own_state) << name;
    EXPECT_GT(result.own_state->rmse_position_m, 0.002);
    EXPECT_LT(result.own_state->rmse_position_m, 0.06);
    EXPECT_LT(result.own_state->rmse_attitude_rad, 0.03);
    EXPECT_GT(result.timing.sensing_stages.own_state, 0.0);
    double apart = 0.0;  // the record tells truth and estimate apart
    for (const RecordSample& row : record.samples) {
      apart = std::max(apart, (row.vehicle.p_WB - row.vehicle_estimate.p_WB).norm());
    }
    EXPECT_GE(apart, result.own_state->max_position_m);
    const TrialResult again = RunTrial(scenario, 1, StandardRegistries());
    EXPECT_EQ(Deterministic(scenario, result), Deterministic(scenario, again)) << name;
  }
}

TEST(OwnFlight, NoOwnSensorMattersToAVehicleThatKnowsItsState) {
  const auto fly = [](const Overrides& overrides) {
    const Scenario scenario = Shipped("open", overrides);
    const TrialResult result = RunTrial(scenario, 1, StandardRegistries());
    EXPECT_FALSE(result.own_state);
    return Deterministic(scenario, result);
  };
  EXPECT_EQ(fly({}), fly({"own.gps.sigma=3", "own.gps.outage=[2, 9]", "own.imu.noise=10"}));
}

// Images that come late are put where the vehicle now knows it was.
TEST(OwnFlight, LateImagesAndEverySensorLandToo) {
  for (const Overrides& choice :
       std::vector<Overrides>{{"camera.latency_ms=80", "depth.latency_ms=80"},
                              {"own.gps.outage=[3, 5]"},
                              {"own.gps.rate=0", "own.odometry.rate=30"}}) {
    Overrides overrides = choice;
    overrides.emplace_back("own_state=estimated");
    const Scenario scenario = Shipped("open", overrides);
    const TrialResult result = RunTrial(scenario, 1, StandardRegistries());
    EXPECT_TRUE(result.landed()) << choice[0] << ": " << result.detail;
  }
}

}  // namespace
}  // namespace touchdown::evaluation
