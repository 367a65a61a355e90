// SPDX-License-Identifier: BSD-3-Clause
#include "control/tracking/lean.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "control/test/flight_model.h"

namespace touchdown::control {
namespace {

constexpr double kQuarter = 0.5 * std::numbers::pi;

estimation::VehicleModel Vehicle() {
  estimation::VehicleModel model = TestVehicle();
  model.hull_bottom = 0.03;
  for (int i = 0; i < 4; ++i) model.foot_azimuths.push_back((i + 0.5) * kQuarter);
  return model;
}

TEST(Lean, FootAndRimTouchTogetherAtTheFeetFirstTilt) {
  const estimation::VehicleModel model = Vehicle();
  const double tilt = FeetFirstTilt(model);
  const Eigen::AngleAxisd lean(tilt, Eigen::Vector3d::UnitY());  // forward
  const Eigen::Vector3d foot = lean * Eigen::Vector3d(model.foot_radius, 0.0, -model.foot_depth);
  const Eigen::Vector3d rim = lean * Eigen::Vector3d(model.hull_radius, 0.0, -model.hull_bottom);
  EXPECT_NEAR(foot.z(), rim.z(), 1e-12);
}

// In any direction, at that tilt the lowest point of the feet is as low as the rim's.
TEST(Lean, BetweenTwoFeetTheRimTouchesSooner) {
  const estimation::VehicleModel model = Vehicle();
  for (double azimuth = -3.0; azimuth < 3.0; azimuth += 0.3) {
    const Eigen::Vector3d axis(-std::sin(azimuth), std::cos(azimuth), 0.0);
    const Eigen::AngleAxisd yaw(0.7, Eigen::Vector3d::UnitZ());
    const double tilt =
        FeetFirstTilt(model, yaw * Eigen::Quaterniond(Eigen::AngleAxisd(0.1, axis)));
    const Eigen::Quaterniond q_WB = yaw * Eigen::Quaterniond(Eigen::AngleAxisd(tilt, axis));
    double foot = 0.0;
    for (const double at : model.foot_azimuths) {
      const Eigen::Vector3d p_BF(model.foot_radius * std::cos(at), model.foot_radius * std::sin(at),
                                 -model.foot_depth);
      foot = std::min(foot, (q_WB * p_BF).z());
    }
    const Eigen::Vector3d p_rim =
        q_WB * Eigen::Vector3d(model.hull_radius * std::cos(azimuth),
                               model.hull_radius * std::sin(azimuth), -model.hull_bottom);
    EXPECT_NEAR(foot, p_rim.z(), 1e-12) << azimuth;
    EXPECT_NEAR(FootDrop(model, q_WB), -model.foot_depth - foot, 1e-12);
    EXPECT_LE(tilt, FeetFirstTilt(model) + 1e-12);
  }
  const Eigen::Quaterniond towards_a_foot(
      Eigen::AngleAxisd(0.1, Eigen::Vector3d(-1.0, 1.0, 0.0).normalized()));
  EXPECT_NEAR(FeetFirstTilt(model, towards_a_foot), FeetFirstTilt(model), 1e-12);
}

TEST(Lean, UnderAForceThrustPointsAgainstItAndTheWeight) {
  EXPECT_DOUBLE_EQ(LeanUnder(10.0, {0.0, 0.0, -3.0}), 0.0);
  EXPECT_NEAR(LeanUnder(10.0, {6.0, 8.0, 0.0}), std::atan(1.0), 1e-12);
  EXPECT_GT(LeanUnder(10.0, {6.0, 8.0, 4.0}), std::atan(1.0)) << "lifted, it leans farther";
}

TEST(Lean, AFootLeadsIntoTheWindByTheShortestTurn) {
  const estimation::VehicleModel model = Vehicle();
  for (double wind = -3.0; wind < 3.1; wind += 0.37) {
    for (double wanted = -3.1; wanted < 3.1; wanted += 0.41) {
      const Eigen::Vector3d force(4.0 * std::cos(wind), 4.0 * std::sin(wind), 1.0);
      const double heading = HeadingIntoWind(model, force, wanted);
      EXPECT_LE(std::abs(estimation::WrapAngle(heading - wanted)), 0.5 * kQuarter + 1e-9);
      double best = 4.0;  // of the angles between the lean and a foot
      for (const double azimuth : model.foot_azimuths) {
        const double off = estimation::WrapAngle(heading + azimuth - (wind + std::numbers::pi));
        best = std::min(best, std::abs(off));
      }
      EXPECT_LT(best, 1e-9) << wind << " " << wanted;
    }
  }
  EXPECT_EQ(HeadingIntoWind(model, {0.0, 0.0, 3.0}, 0.3), 0.3);
  EXPECT_EQ(HeadingIntoWind(TestVehicle(), {1.0, 0.0, 0.0}, 0.3), 0.3);
}

}  // namespace
}  // namespace touchdown::control
