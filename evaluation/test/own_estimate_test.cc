// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/own_estimate.h"

#include <gtest/gtest.h>

#include "evaluation/flight/closed_loop.h"
#include "evaluation/flight/depth_eye.h"
#include "evaluation/record/trial_json.h"
#include "evaluation/scenario/scenario_world.h"
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

TEST(OwnEstimate, TheTruthIsKnownExactly) {
  OwnEstimate own(Scenario{}, Start(), 0.002, 1);
  EXPECT_FALSE(own.estimated());
  estimation::VehicleState truth = Start();
  truth.t = 0.4;
  truth.p_WB.x() = 7.0;
  own.Sense(truth);
  EXPECT_EQ(own.now().t, 0.4);
  EXPECT_EQ(own.now().p_WB, truth.p_WB);
  EXPECT_EQ(own.At(Start()).p_WB, Start().p_WB);
  EXPECT_EQ(own.status(), estimation::OwnStatus::kGood);
  EXPECT_EQ(own.HorizontalSigma(), 0.0);
}

TEST(OwnEstimate, TheDefaultsAreThoseOfTheSensors) {
  const sim::OwnStateSourceConfig config = OwnSourceConfig(Scenario{});
  const sim::OwnStateSourceConfig defaults;
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

// A vehicle that stands still: what is known of a past time, and how far, with and without fixes.
TEST(OwnEstimate, AnOutageIsToldAndItsDoubtGrows) {
  Scenario scenario = Shipped("open", {"own_state=estimated", "own.gps.outage=[1, 4]"});
  OwnEstimate own(scenario, Start(), 0.002, 3);
  ASSERT_TRUE(own.estimated());
  estimation::VehicleState truth = Start();
  double sigma_before = 0.0;
  for (int k = 0; k <= 2500; ++k) {
    truth.t = 0.002 * k;
    own.Sense(truth);
    ASSERT_EQ(own.now().t, truth.t);
    if (k == 500) sigma_before = own.HorizontalSigma();
    if (k == 1900) {
      EXPECT_EQ(own.status(), estimation::OwnStatus::kOutage);
      EXPECT_GT(own.HorizontalSigma(), 3.0 * sigma_before);
    }
  }
  EXPECT_EQ(own.status(), estimation::OwnStatus::kGood);
  EXPECT_LT((own.now().p_WB - truth.p_WB).norm(), 0.1);
  truth.t = 4.7;
  EXPECT_NEAR(own.At(truth).t, 4.7, 1e-9);
  EXPECT_LT((own.At(truth).p_WB - truth.p_WB).norm(), 0.1);
}

// A frame that is moved to the believed state is the frame that a camera there would have been at.
TEST(OwnEstimate, AFrameIsPlacedWhereTheVehicleBelievesItselfToBe) {
  const Scenario scenario = Shipped("open", {});
  const sim::WorldConfig world = WorldOf(scenario, DrawTrial(scenario, 1), StandardRegistries());
  const estimation::VehicleState truth = Start();
  estimation::VehicleState believed = truth;
  believed.p_WB += Eigen::Vector3d(0.3, -0.2, 0.1);
  believed.q_WB = truth.q_WB * Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.6, 0.0, 0.8));
  const auto frame_at = [&](const estimation::VehicleState& vehicle) {
    const auto eye = MakeDepthEye(scenario, world, 1);
    SensingTimes times;
    eye->Look(vehicle, {}, &times);
    return eye->Poll(vehicle.t)->frame;
  };
  estimation::DepthFrame frame = frame_at(truth);
  PlaceFrame(truth, believed, &frame);
  const estimation::DepthFrame there = frame_at(believed);
  EXPECT_LT((frame.p_WC - there.p_WC).norm(), 1e-12);
  EXPECT_LT((frame.R_WC - there.R_WC).norm(), 1e-12);
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
