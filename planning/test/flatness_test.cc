// SPDX-License-Identifier: BSD-3-Clause
// Differential flatness: attitude and rates against finite differences along a smooth trajectory.

#include "touchdown/planning/spline/flatness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {
namespace {

/// A helix with a turning heading: every derivative known.
FlatState Helix(double t) {
  const double w = 1.3, r = 1.5;
  FlatState f;
  f.p_WB = {r * std::cos(w * t), r * std::sin(w * t), 0.4 * t + 0.2 * std::sin(t)};
  f.v_WB = {-r * w * std::sin(w * t), r * w * std::cos(w * t), 0.4 + 0.2 * std::cos(t)};
  f.a_WB = {-r * w * w * std::cos(w * t), -r * w * w * std::sin(w * t), -0.2 * std::sin(t)};
  f.j_WB = {r * w * w * w * std::sin(w * t), -r * w * w * w * std::cos(w * t), -0.2 * std::cos(t)};
  f.yaw = 0.3 + 0.9 * t;
  f.yaw_rate = 0.9;
  return f;
}

TEST(Flatness, ThrustCarriesGravityAndAcceleration) {
  for (double t = 0.0; t < 6.0; t += 0.31) {
    const FlatState f = Helix(t);
    const FlatInputs in = InvertFlatness(f);
    const Eigen::Vector3d thrust = in.specific_thrust * in.R_WB.col(2);
    EXPECT_LT((thrust - f.a_WB - Eigen::Vector3d(0, 0, estimation::kGravity)).norm(), 1e-12);
    EXPECT_LT((in.R_WB * in.R_WB.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(in.R_WB.determinant(), 1.0, 1e-12);
    // The body x axis has the heading: no part of it to the heading's left.
    EXPECT_NEAR(in.R_WB.col(1).dot(Eigen::Vector3d(std::cos(f.yaw), std::sin(f.yaw), 0)), 0, 1e-12);
  }
}

TEST(Flatness, BodyRateIsTheAttitudesDerivative) {
  const double dt = 1e-6;
  for (double t = 0.1; t < 6.0; t += 0.31) {
    const FlatInputs at = InvertFlatness(Helix(t));
    const Eigen::Matrix3d dR =
        (InvertFlatness(Helix(t + dt)).R_WB - InvertFlatness(Helix(t - dt)).R_WB) / (2 * dt);
    const Eigen::Matrix3d w_hat = at.R_WB.transpose() * dR;
    const Eigen::Vector3d w(w_hat(2, 1), w_hat(0, 2), w_hat(1, 0));
    EXPECT_LT((w - at.w_WB_B).norm(), 1e-6);
  }
}

TEST(Flatness, FreeFallAndThrustAlongTheHeadingAreDefined) {
  FlatState fall;
  fall.a_WB = {0, 0, -estimation::kGravity};
  EXPECT_TRUE(InvertFlatness(fall).R_WB.allFinite());
  EXPECT_EQ(InvertFlatness(fall).w_WB_B.norm(), 0.0);
  EXPECT_TRUE(AttitudeFromThrust({1, 0, 0}, 0.0).allFinite());
}

}  // namespace
}  // namespace touchdown::planning
