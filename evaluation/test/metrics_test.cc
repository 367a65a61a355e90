// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/judge/metrics.h"

#include <gtest/gtest.h>

#include "evaluation/base/sliding_mean.h"

namespace touchdown::evaluation {
namespace {

TEST(Metrics, TheErrorIsAveragedOverTheLastFiveSecondsOnly) {
  Metrics metrics;
  estimation::VehicleState vehicle;
  const estimation::PadState pad;
  for (int i = 0; i <= 500; ++i) {
    const double t = 0.02 * i;
    // 100 m away in the first half of 10 s; then 0.2 m in x and, with both signs, 0.1 m in y.
    vehicle.p_WB = t < 4.99 ? Eigen::Vector3d(100.0, 0.0, 0.0)
                            : Eigen::Vector3d(-0.2, i % 2 == 0 ? 0.1 : -0.1, 0.0);
    metrics.Sample(t, vehicle, pad);
    metrics.Step(estimation::Commands(), false, 0.02);
  }
  TrialResult result;
  result.touchdown = Touchdown{};
  metrics.Fill(&result);
  EXPECT_NEAR(*result.mean_abs_error_x_m, 0.2, 1e-12);
  EXPECT_NEAR(*result.mean_abs_error_y_m, 0.1, 1e-12);
}

TEST(Metrics, FollowingIsOverTheLastTenSecondsAndNotLess) {
  Metrics metrics;
  estimation::VehicleState vehicle;
  estimation::PadState pad;
  pad.v_WP = {1.0, 0.0, 0.0};
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.02 * i;
    // 100 m away at first. Then 0.3 m, once 0.5 m, and half a metre per second too slow.
    vehicle.p_WB = {t < 9.97 ? 100.0 : 0.0, i == 800 ? -0.5 : -0.3, 1.7};
    vehicle.v_WB = {0.5, 0.0, 0.0};
    metrics.Sample(t, vehicle, pad);
    EXPECT_EQ(metrics.LastFollowing().has_value(), i >= 500) << t;
  }
  const Following following = *metrics.LastFollowing();
  EXPECT_NEAR(following.mean_error_m, 0.3 + 0.2 / 501.0, 1e-9);
  EXPECT_NEAR(following.max_error_m, 0.5, 1e-12);
  EXPECT_NEAR(following.relative_speed_mps, 0.5, 1e-12);
}

TEST(Metrics, FieldsAtContactStayEmptyWithoutContact) {
  Metrics metrics;
  metrics.Sample(0.0, {}, {});
  TrialResult result;
  metrics.Fill(&result);
  EXPECT_FALSE(result.mean_abs_error_x_m.has_value());
  EXPECT_FALSE(result.estimator.has_value());
  EXPECT_FALSE(result.own_state.has_value());
}

TEST(Metrics, TheOwnStatesErrorIsMeanSquareAndLargest) {
  Metrics metrics;
  estimation::VehicleState truth, estimate;
  estimate.p_WB = {0.3, 0.0, 0.4};
  metrics.OwnState(estimate, truth);
  estimate.p_WB.setZero();
  estimate.v_WB.y() = -2.0;
  estimate.q_WB = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
  metrics.OwnState(estimate, truth);
  TrialResult result;
  metrics.Fill(&result);
  ASSERT_TRUE(result.own_state);
  EXPECT_NEAR(result.own_state->rmse_position_m, 0.5 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(result.own_state->max_position_m, 0.5, 1e-12);
  EXPECT_NEAR(result.own_state->rmse_velocity_mps, 2.0 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(result.own_state->max_attitude_rad, 0.2, 1e-12);
}

TEST(Metrics, EffortAndSaturationAddUp) {
  Metrics metrics;
  for (int i = 0; i < 100; ++i) metrics.Step(Eigen::Vector4d(1.0, 2.0, 3.0, 4.0), i < 25, 0.002);
  TrialResult result;
  metrics.Fill(&result);
  EXPECT_NEAR(result.effort_n2s, 30.0 * 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(result.saturation_share, 0.25);
}

TEST(Metrics, NeesOfAnHonestErrorIsItsChiSquare) {
  Metrics metrics;
  estimation::PadState estimate;
  estimate.cov_p = Eigen::Matrix2d::Identity() * 0.04;
  estimate.p_WP = {0.2, -0.2, 0.0};
  metrics.Estimate(estimate, {}, Eigen::Vector3d::Zero());
  TrialResult result;
  metrics.Fill(&result);
  EXPECT_NEAR(result.estimator->nees_position_mean, 2.0, 1e-12);
  EXPECT_NEAR(result.estimator->rmse_position_m, std::sqrt(0.08), 1e-12);
}

TEST(Metrics, ThePadIsComparedAsSeenFromTheVehicle) {
  Metrics metrics;
  estimation::PadState estimate, truth;
  estimate.cov_p = Eigen::Matrix2d::Identity() * 0.01;
  truth.p_WP = {5.0, 1.0, 0.3};
  // The estimates of vehicle and pad are 3 m off. Relative to the vehicle the pad is off by 0.1 m.
  const Eigen::Vector3d own_error(3.0, 0.0, 0.5);
  estimate.p_WP = {8.0, 1.1, 0.3};
  metrics.Estimate(estimate, truth, own_error);
  TrialResult result;
  metrics.Fill(&result);
  EXPECT_NEAR(result.estimator->rmse_position_m, 0.1, 1e-12);
  EXPECT_NEAR(result.estimator->nees_position_mean, 1.0, 1e-12);
}

TEST(SlidingMean, ForgetsAfterOneSecond) {
  SlidingMean mean;
  EXPECT_TRUE(mean.Mean().isZero());
  mean.Add(0.0, Eigen::Vector3d::Constant(100.0));
  mean.Add(1.5, Eigen::Vector3d::Constant(1.0));
  mean.Add(2.0, Eigen::Vector3d::Constant(3.0));
  EXPECT_TRUE(mean.Mean().isApprox(Eigen::Vector3d::Constant(2.0)));
}

}  // namespace
}  // namespace touchdown::evaluation
