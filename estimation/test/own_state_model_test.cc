// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/own_state/own_state_model.h"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "estimation/base/chi_squared.h"
#include "estimation/base/rotation_vector.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::estimation {
namespace {

struct Case {
  OwnState state;
  ImuSample imu;
};

Case DrawCase(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](double scale) {
    const double x = normal(random);
    const double y = normal(random);
    const double z = normal(random);
    return Eigen::Vector3d(scale * x, scale * y, scale * z);
  };
  Case c;
  c.state.p_WB = draw(5.0);
  c.state.v_WB = draw(3.0);
  c.state.q_WB = ExpRotation(draw(0.6));
  c.state.accelerometer_bias = draw(0.1);
  c.state.gyro_bias = draw(0.02);
  c.imu.f_B = Eigen::Vector3d(0.0, 0.0, kGravity) + draw(3.0);
  c.imu.w_WB_B = draw(3.0);
  return c;
}

constexpr double kStep = 1e-6;

TEST(RotationVector, ExpAndLogAreInverse) {
  for (double angle : {0.0, 1e-12, 1e-6, 1e-4, 0.1, 1.0, 3.0, 3.14159}) {
    const Eigen::Vector3d phi = angle * Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0;
    EXPECT_LT((LogRotation(ExpRotation(phi)) - phi).norm(), 1e-12) << angle;
    const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0;
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((ExpRotation(phi).toRotationMatrix() - R).norm(), 1e-12) << angle;
    Eigen::Quaterniond other = ExpRotation(phi);
    other.coeffs() *= -1.0;  // the same rotation
    EXPECT_LT((LogRotation(other) - phi).norm(), 1e-12) << angle;
  }
}

TEST(RotationVector, TheShortestTurnBringsOneDirectionIntoTheOther) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d from(normal(random), normal(random), normal(random));
    const Eigen::Vector3d to(normal(random), normal(random), normal(random));
    const Eigen::Quaterniond turn = ShortestTurn(from, to);
    EXPECT_NEAR(turn.norm(), 1.0, 1e-12);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-12);
    EXPECT_NEAR(LogRotation(turn).dot(from), 0.0, 1e-9);
    EXPECT_LT((ShortestTurn(from, -3.0 * from) * from + from).norm(), 1e-5 * from.norm());
    EXPECT_LT((ShortestTurn(from, 2.0 * from) * from - from).norm(), 1e-12 * from.norm());
  }
}

TEST(RotationVector, RightJacobianAgreesWithDifferences) {
  for (double angle : {0.0, 5e-4, 0.01, 1.0, 3.0}) {
    const Eigen::Vector3d phi = angle * Eigen::Vector3d(2.0, 1.0, -2.0) / 3.0;
    const Eigen::Matrix3d J = RightJacobian(phi);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d column =
          (LogRotation(ExpRotation(phi).conjugate() * ExpRotation(phi + d)) -
           LogRotation(ExpRotation(phi).conjugate() * ExpRotation(phi - d))) /
          (2.0 * kStep);
      EXPECT_LT((column - J.col(i)).norm(), 1e-8) << angle;
    }
  }
}

TEST(OwnStateModel, TransitionAgreesWithDifferences) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Case c = DrawCase(seed);
    for (double dt : {0.002, 0.05}) {
      const auto F = OwnTransition(c.state, c.imu, dt);
      const OwnState base = PropagateOwnState(c.state, c.imu, dt);
      for (int i = 0; i < kOwnErrors; ++i) {
        const OwnVector d = kStep * OwnVector::Unit(i);
        const OwnVector column =
            (OwnErrorBetween(base, PropagateOwnState(AddOwnError(c.state, d), c.imu, dt)) -
             OwnErrorBetween(base, PropagateOwnState(AddOwnError(c.state, -d), c.imu, dt))) /
            (2.0 * kStep);
        EXPECT_LT((column.head<9>() - F.col(i)).norm(), 1e-7) << seed << " " << i;
        EXPECT_LT((column.tail<6>() - OwnVector::Unit(i).tail<6>()).norm(), 1e-7);
      }
    }
  }
}

TEST(OwnStateModel, MeasurementJacobiansAgreeWithDifferences) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const OwnState state = DrawCase(seed).state;
    Eigen::Matrix<double, 3, kOwnErrors> velocity, force, unused;
    Eigen::Matrix<double, 1, kOwnErrors> heading, unused_row;
    OwnVelocityInB(state, &velocity);
    OwnHoverForce(state, &force);
    OwnHeading(state, &heading);
    for (int i = 0; i < kOwnErrors; ++i) {
      const OwnState plus = AddOwnError(state, kStep * OwnVector::Unit(i));
      const OwnState minus = AddOwnError(state, -kStep * OwnVector::Unit(i));
      const double by = 1.0 / (2.0 * kStep);
      const Eigen::Vector3d dv =
          by * (OwnVelocityInB(plus, &unused) - OwnVelocityInB(minus, &unused));
      const Eigen::Vector3d df =
          by * (OwnHoverForce(plus, &unused) - OwnHoverForce(minus, &unused));
      const double dyaw =
          by * WrapAngle(OwnHeading(plus, &unused_row) - OwnHeading(minus, &unused_row));
      EXPECT_LT((dv - velocity.col(i)).norm(), 1e-8) << seed << " " << i;
      EXPECT_LT((df - force.col(i)).norm(), 1e-7) << seed << " " << i;
      EXPECT_NEAR(dyaw, heading(i), 1e-6) << seed << " " << i;
    }
  }
}

TEST(OwnStateModel, CovarianceGrowsByTheNoiseAndStaysSymmetric) {
  const Case c = DrawCase(3);
  const ImuNoise noise;
  OwnBelief belief{c.state, OwnMatrix::Zero()};
  const OwnBelief next = PropagateOwnBelief(belief, c.imu, 0.01, noise);
  EXPECT_DOUBLE_EQ(next.cov(kVelocityError, kVelocityError),
                   noise.accelerometer * noise.accelerometer * 0.01);
  EXPECT_DOUBLE_EQ(next.cov(kGyroError, kGyroError), noise.gyro_walk * noise.gyro_walk * 0.01);
  belief.cov = OwnMatrix::Identity();
  const OwnMatrix cov = PropagateOwnBelief(belief, c.imu, 0.01, noise).cov;
  EXPECT_EQ((cov - cov.transpose()).norm(), 0.0);
}

TEST(ChiSquared, AgreesWithBoost) {
  for (int degrees = 1; degrees <= 3; ++degrees) {
    const boost::math::chi_squared law(degrees);
    for (double p : {0.01, 0.5, 0.95, 0.999}) {
      EXPECT_NEAR(ChiSquaredQuantile(degrees, p), quantile(law, p), 1e-9);
    }
  }
  EXPECT_THROW(ChiSquaredQuantile(4, 0.5), std::invalid_argument);
  EXPECT_THROW(ChiSquaredQuantile(1, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::estimation
