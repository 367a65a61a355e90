// SPDX-License-Identifier: BSD-3-Clause
#include "sim/air/drag.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace touchdown::sim {
namespace {

estimation::VehicleModel Model() {
  estimation::VehicleModel model;
  model.rotor_drag = {0.2, 0.3, 0.0};
  model.body_drag_area = 0.03;
  return model;
}

TEST(Drag, ByHand) {
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d forward = DragForce(Model(), level, {4.0, 0.0, 0.0});
  EXPECT_NEAR(forward.x(), -(0.2 * 4.0 + 0.5 * 1.225 * 0.03 * 16.0), 1e-12);
  const Eigen::Vector3d up = DragForce(Model(), level, {0.0, 0.0, 2.0});
  EXPECT_NEAR(up.z(), -0.5 * 1.225 * 0.03 * 4.0, 1e-12);
}

TEST(Drag, TurnsWithTheVehicleAndTakesEnergyOut) {
  const Eigen::Matrix3d R_WB =
      (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized())).toRotationMatrix();
  const Eigen::Vector3d u(3.0, -2.0, 1.0);
  const Eigen::Vector3d turned =
      R_WB * DragForce(Model(), Eigen::Matrix3d::Identity(), R_WB.transpose() * u);
  EXPECT_LT((DragForce(Model(), R_WB, u) - turned).norm(), 1e-12);
  EXPECT_LT(DragForce(Model(), R_WB, u).dot(u), 0.0);
  EXPECT_EQ(DragForce(Model(), R_WB, Eigen::Vector3d::Zero()).norm(), 0.0);
}

}  // namespace
}  // namespace touchdown::sim
