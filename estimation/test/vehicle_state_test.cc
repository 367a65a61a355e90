// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/base/vehicle_state.h"

#include <numbers>

#include <gtest/gtest.h>

namespace touchdown::estimation {
namespace {

TEST(VehicleState, YawAndTiltOfAComposedAttitude) {
  const Eigen::Quaterniond q_WB = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  EXPECT_NEAR(Yaw(q_WB), 2.0, 1e-12);
  EXPECT_NEAR(Tilt(q_WB), 0.3, 1e-12);
}

TEST(VehicleState, AnglesWrapToTheHalfOpenTurn) {
  EXPECT_DOUBLE_EQ(WrapAngle(std::numbers::pi), std::numbers::pi);
  EXPECT_DOUBLE_EQ(WrapAngle(-std::numbers::pi), std::numbers::pi);
  EXPECT_NEAR(WrapAngle(7.0), 7.0 - 2.0 * std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace touchdown::estimation
