// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/base/covariance.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

namespace touchdown::estimation {
namespace {

TEST(LargestVariance, IsThatOfTheEigensolver) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    const Eigen::Matrix2d root = Eigen::Matrix2d::NullaryExpr([&] { return normal(random); });
    const Eigen::Matrix2d cov = root * root.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(cov, Eigen::EigenvaluesOnly);
    EXPECT_NEAR(LargestVariance(cov), eigen.eigenvalues()(1), 1e-12 * cov.trace());
  }
  EXPECT_EQ(LargestVariance(Eigen::Vector2d(4.0, 9.0).asDiagonal()), 9.0);
  EXPECT_EQ(LargestVariance(Eigen::Matrix2d::Zero()), 0.0);
}

}  // namespace
}  // namespace touchdown::estimation
