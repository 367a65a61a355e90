// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/gps.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace touchdown::sim {
namespace {

TEST(PadGps, OutagesAndOutliersLeaveTheOtherFixesAlone) {
  PadGps plain({0.5, 10.0}, 5);
  PadGpsConfig config;
  config.sigma = 0.5;
  config.outage_begin_s = 20.0;
  config.outage_end_s = 22.0;
  config.outlier_probability = 0.1;
  config.outlier_size = 10.0;
  PadGps faulty(config, 5);
  int missing = 0;
  int outliers = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto good = plain.Poll(0.1 * i, {});
    const auto fix = faulty.Poll(0.1 * i, {});
    ASSERT_TRUE(good.has_value());
    if (!fix) {
      ++missing;
      EXPECT_GE(good->t, 20.0 - 1e-9);
      EXPECT_LT(good->t, 22.0);
      continue;
    }
    EXPECT_EQ(fix->sigma, 0.5);
    const double off = (fix->p_WP - good->p_WP).norm();
    if (off == 0.0) continue;
    EXPECT_NEAR(off, 10.0, 1e-9);
    ++outliers;
  }
  EXPECT_NEAR(missing, 20, 1);
  EXPECT_NEAR(outliers, 1000, 120);
  config.outlier_probability = 1.5;
  EXPECT_THROW(PadGps(config, 5), std::invalid_argument);
}

TEST(PadGps, NoiseHasTheStatedSpreadAndNoMemory) {
  const double sigma = 0.5;
  PadGps gps({sigma, 10.0}, 11);
  estimation::PadState pad;
  pad.p_WP = {3.0, -4.0, 0.3};
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double lag_one = 0.0;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const auto fix = gps.Poll(0.1 * i, pad);
    ASSERT_TRUE(fix.has_value());
    EXPECT_EQ(fix->sigma, sigma);
    EXPECT_EQ(fix->t, 0.1 * i);
    const Eigen::Vector2d error = (fix->p_WP - pad.p_WP.head<2>()) / sigma;
    mean += error / n;
    covariance += error * error.transpose() / n;
    lag_one += error.dot(last) / (2.0 * n);
    last = error;
  }
  const double bound = 4.0 / std::sqrt(n);
  EXPECT_LT(mean.norm(), 1.5 * bound);
  EXPECT_LT((covariance - Eigen::Matrix2d::Identity()).norm(), 3.0 * bound);
  EXPECT_LT(std::abs(lag_one), bound);
}

TEST(PadGps, KeepsItsRate) {
  PadGps gps({0.01, 10.0}, 1);
  int fixes = 0;
  for (int step = 0; step < 5000; ++step) fixes += gps.Poll(0.002 * step, {}).has_value() ? 1 : 0;
  EXPECT_EQ(fixes, 100);
}

TEST(PadGps, SigmaScalesTheSameDraws) {
  PadGps fine({0.01, 10.0}, 9);
  PadGps coarse({1.0, 10.0}, 9);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d small = fine.Poll(0.1 * i, {})->p_WP;
    const Eigen::Vector2d large = coarse.Poll(0.1 * i, {})->p_WP;
    EXPECT_LT((100.0 * small - large).norm(), 1e-12);
  }
}

TEST(PadGps, RefusesBadConfigurations) {
  EXPECT_THROW(PadGps({-0.1, 10.0}, 1), std::invalid_argument);
  EXPECT_THROW(PadGps({0.1, 0.0}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
