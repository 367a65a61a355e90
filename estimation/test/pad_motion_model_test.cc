// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/pad/pad_motion_model.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "estimation/test/pad_drive.h"
#include "touchdown/estimation/pad/pad_predictor.h"

namespace touchdown::estimation {
namespace {

constexpr PadMotion kMotions[] = {PadMotion::kVelocity, PadMotion::kHeading, PadMotion::kTurn};

PadVector RandomMean(PadMotion motion, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  PadVector mean;
  for (int i = 0; i < 5; ++i) mean(i) = uniform(random);
  mean(3) *= motion == PadMotion::kVelocity ? 1.0 : 3.0;
  if (motion != PadMotion::kTurn) mean(4) = 0.0;
  // A third each: ordinary, tiny (the series), exactly zero turn rate.
  const double kind = uniform(random);
  if (kind > 0.33) mean(4) *= 1e-5;
  if (kind < -0.33) mean(4) = 0.0;
  return mean;
}

TEST(PadMotionModel, JacobianAgreesWithDifferences) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> time(-3.0, 3.0);
  for (PadMotion motion : kMotions) {
    for (int trial = 0; trial < 200; ++trial) {
      const PadVector mean = RandomMean(motion, random);
      const double dt = time(random);
      const PadMatrix jacobian = PropagateJacobian(motion, mean, dt);
      for (int j = 0; j < StateSize(motion); ++j) {
        const double h = 1e-5;
        PadVector above = mean;
        PadVector below = mean;
        above(j) += h;
        below(j) -= h;
        const PadVector column =
            (Propagate(motion, above, dt) - Propagate(motion, below, dt)) / (2.0 * h);
        EXPECT_LT((jacobian.col(j) - column).norm(), 1e-8) << "column " << j << ", dt " << dt;
      }
    }
  }
}

TEST(PadMotionModel, TwoStepsMakeOne) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> time(-2.0, 2.0);
  for (PadMotion motion : kMotions) {
    for (int trial = 0; trial < 200; ++trial) {
      const PadVector mean = RandomMean(motion, random);
      const double a = time(random);
      const double b = time(random);
      const PadVector twice = Propagate(motion, Propagate(motion, mean, a), b);
      EXPECT_LT((twice - Propagate(motion, mean, a + b)).norm(), 1e-12);
    }
  }
}

TEST(PadMotionModel, SeriesMeetsClosedForm) {
  // u = omega dt / 2 just below and above the switch at 0.05.
  const PadVector below = PadStart(0, 0, 1.0, 0.4, 0.1 - 1e-9);
  const PadVector above = PadStart(0, 0, 1.0, 0.4, 0.1 + 1e-9);
  EXPECT_LT(
      (Propagate(PadMotion::kTurn, below, 1.0) - Propagate(PadMotion::kTurn, above, 1.0)).norm(),
      1e-8);
  EXPECT_LT((PropagateJacobian(PadMotion::kTurn, below, 1.0) -
             PropagateJacobian(PadMotion::kTurn, above, 1.0))
                .norm(),
            1e-8);
}

TEST(PadMotionModel, NoiseOfConstantVelocityIsExact) {
  PadNoise noise;
  noise.position = 0.01;
  noise.velocity = 0.3;
  const double dt = 0.7;
  const PadMatrix added = ProcessNoise(PadMotion::kVelocity, PadStart(1, 2, 0.5, -0.5), dt, noise);
  EXPECT_NEAR(added(0, 0), 0.01 * dt + 0.3 * dt * dt * dt / 3.0, 1e-14);
  EXPECT_NEAR(added(0, 2), 0.3 * dt * dt / 2.0, 1e-14);
  EXPECT_NEAR(added(2, 2), 0.3 * dt, 1e-14);
  EXPECT_EQ(added(0, 1), 0.0);
}

TEST(PadMotionModel, NoiseIsPositiveSemidefiniteAndAddsUp) {
  std::mt19937_64 random(3);
  const PadNoise noise;
  for (PadMotion motion : kMotions) {
    for (int trial = 0; trial < 50; ++trial) {
      const PadVector mean = RandomMean(motion, random);
      const PadMatrix whole = ProcessNoise(motion, mean, 0.2, noise);
      const Eigen::SelfAdjointEigenSolver<PadMatrix> eigen(whole);
      EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-15);
      // The two halves, the first carried over the second.
      const PadVector middle = Propagate(motion, mean, 0.1);
      const PadMatrix phi = PropagateJacobian(motion, middle, 0.1);
      const PadMatrix sum = phi * ProcessNoise(motion, mean, 0.1, noise) * phi.transpose() +
                            ProcessNoise(motion, middle, 0.1, noise);
      EXPECT_LT((whole - sum).norm(), 1e-8 * whole.norm());
    }
  }
}

TEST(BeliefPrediction, DerivativesAreExact) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> time(-1.0, 4.0);
  for (PadMotion motion : kMotions) {
    for (int trial = 0; trial < 200; ++trial) {
      PadBelief belief;
      belief.t = 12.0;
      belief.motion = motion;
      belief.mean = RandomMean(motion, random);
      belief.cov.diagonal().head(StateSize(motion)).setConstant(1e-3);
      const BeliefPrediction prediction(belief, 0.3, PadNoise{});
      const double t = belief.t + time(random);
      const double h = 1e-4;
      const PadState now = prediction.At(t);
      const PadState after = prediction.At(t + h);
      const PadState before = prediction.At(t - h);
      EXPECT_LT(((after.p_WP - before.p_WP) / (2 * h) - now.v_WP).norm(), 1e-8);
      EXPECT_LT(((after.v_WP - before.v_WP) / (2 * h) - now.a_WP).norm(), 1e-8);
      EXPECT_LT(((after.a_WP - before.a_WP) / (2 * h) - now.j_WP).norm(), 1e-8);
      EXPECT_NEAR(WrapAngle(after.yaw - before.yaw) / (2 * h), now.yaw_rate, 1e-8);
      EXPECT_EQ(now.p_WP.z(), 0.3);
    }
  }
}

TEST(BeliefPrediction, TheMeanIsTheStateWithoutItsCovariance) {
  for (const PadMotion motion : {PadMotion::kVelocity, PadMotion::kHeading, PadMotion::kTurn}) {
    PadBelief belief;
    belief.motion = motion;
    belief.t = 2.0;
    belief.mean = PadStart(1, 2, 0.8, 0.1, motion == PadMotion::kTurn ? 0.15 : 0.0);
    belief.cov.setIdentity();
    const BeliefPrediction prediction(belief, 0.3, PadNoise{});
    for (const double t : {-3.0, 2.0, 2.5, 40.0}) {
      const PadState at = prediction.At(t), mean = prediction.MeanAt(t);
      EXPECT_EQ(mean.p_WP, at.p_WP);
      EXPECT_EQ(mean.v_WP, at.v_WP);
      EXPECT_EQ(mean.a_WP, at.a_WP);
      EXPECT_EQ(mean.j_WP, at.j_WP);
      EXPECT_EQ(mean.yaw, at.yaw);
      EXPECT_EQ(mean.yaw_rate, at.yaw_rate);
      EXPECT_TRUE(mean.cov_p.isZero(0.0));
      EXPECT_GT(at.cov_p.trace(), 1.0);
    }
  }
}

TEST(BeliefPrediction, AnyFiniteTimeIsFinite) {
  PadBelief belief;
  belief.motion = PadMotion::kTurn;
  belief.mean = PadStart(1, 2, 0.8, 0.1, 0.15);
  belief.cov.setIdentity();
  const BeliefPrediction prediction(belief, 0.0, PadNoise{});
  for (double t : {-1e6, -10.0, 0.0, 1e-12, 10.0, 1e6}) {
    const PadState pad = prediction.At(t);
    EXPECT_TRUE(pad.p_WP.allFinite() && pad.cov_p.allFinite()) << t;
    EXPECT_GE(pad.cov_p.determinant(), 0.0);
  }
}

TEST(BeliefPrediction, UnknownTurnRateDoesNotBendTheFuture) {
  PadBelief belief;
  belief.motion = PadMotion::kTurn;
  belief.mean = PadStart(0, 0, 0.8, 0.0, 0.1);
  belief.cov.diagonal() << 1e-4, 1e-4, 1e-4, 1e-4, 0.3 * 0.3;
  const BeliefPrediction unsure(belief, 0.0, PadNoise{});
  EXPECT_NEAR(unsure.At(0.0).yaw_rate, 0.01, 1e-12);
  belief.cov(4, 4) = 0.01 * 0.01;
  const BeliefPrediction sure(belief, 0.0, PadNoise{});
  EXPECT_NEAR(sure.At(0.0).yaw_rate, 0.1, 1.1e-3);
  EXPECT_EQ(BeliefPrediction(PadBelief{}, 0.0, PadNoise{}).At(1.0).yaw_rate, 0.0);
}

TEST(BeliefPrediction, ReversingPadKeepsItsHeading) {
  PadBelief belief;
  belief.motion = PadMotion::kHeading;
  belief.mean = PadStart(0, 0, -0.5, 1.0);
  const PadState pad = BeliefPrediction(belief, 0.0, PadNoise{}).At(2.0);
  EXPECT_DOUBLE_EQ(pad.yaw, 1.0);
  EXPECT_NEAR(pad.v_WP.x(), -0.5 * std::cos(1.0), 1e-15);
}

}  // namespace
}  // namespace touchdown::estimation
