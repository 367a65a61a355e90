// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/own_state/own_state_filter.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "estimation/test/own_flight.h"

namespace touchdown::estimation {
namespace {

TEST(OwnStateFilter, StartsByItselfFromAHover) {
  OwnStateFilter filter;
  EXPECT_EQ(filter.Status(0.0), OwnStatus::kNoImu);
  EXPECT_TRUE(std::isinf(filter.PositionSigma()));
  const double yaw = 0.7;
  const Eigen::Quaterniond q_WB(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  ImuSample imu;
  imu.f_B = q_WB.conjugate() * Eigen::Vector3d(0.0, 0.0, kGravity);
  OwnUpdate last = OwnUpdate::kWaiting;
  int samples = 0;
  for (int k = 0; k <= 300 && last == OwnUpdate::kWaiting; ++k) {
    imu.t = 0.004 * k;
    last = filter.AddImu(imu);
    ++samples;
    if (k == 10) {
      EXPECT_EQ(filter.Status(imu.t), OwnStatus::kAligning);
      EXPECT_EQ(filter.AddHeading({imu.t, yaw, 0.02}), OwnUpdate::kWaiting);
    }
    if (k == 280) {
      EXPECT_EQ(filter.AddPosition({imu.t, {1.0, 2.0, 3.0}, 0.02, 0.04}), OwnUpdate::kWaiting);
    }
  }
  EXPECT_EQ(last, OwnUpdate::kStarted);
  EXPECT_EQ(samples, 282);  // what came last was the position
  const VehicleState state = filter.Estimate();
  EXPECT_LT(LogRotation(state.q_WB.conjugate() * q_WB).norm(), 1e-6);
  EXPECT_LT((state.p_WB - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-9);
  // Tilt is known except for the part that the accelerometer's bias hides.
  const double tilt = std::sqrt(filter.belief().cov(kAttitudeError, kAttitudeError));
  EXPECT_NEAR(tilt, std::hypot(0.05, 0.05) / kGravity, 1e-3);
}

TEST(OwnStateFilter, FindsTheBiases) {
  // With turns and accelerations, a bias is known within 20 s up to its random walk of that time.
  double accelerometer2 = 0.0;
  double gyro2 = 0.0;
  const int runs = 20;
  for (unsigned run = 0; run < runs; ++run) {
    OwnRig rig;
    OwnRun flight(40 + run, 1.5, rig);
    flight.StartFromPrior();
    flight.FlyTo(20.0);
    accelerometer2 += flight.Error().segment<3>(kAccelerometerError).squaredNorm() / (3 * runs);
    gyro2 += flight.Error().segment<3>(kGyroError).squaredNorm() / (3 * runs);
  }
  const OwnStartSigma prior;
  RecordProperty("accelerometer_mps2", std::to_string(std::sqrt(accelerometer2)));
  RecordProperty("gyro_radps", std::to_string(std::sqrt(gyro2)));
  EXPECT_LT(std::sqrt(accelerometer2), 0.4 * prior.accelerometer);
  EXPECT_LT(std::sqrt(gyro2), 0.2 * prior.gyro);
}

TEST(OwnStateFilter, EstimateIsAheadByWhatIsAsked) {
  OwnRig rig;
  OwnRun flight(3, 1.0, rig);
  flight.StartFromPrior();
  flight.FlyTo(4.0);
  const VehicleState now = flight.filter.Estimate();
  const VehicleState ahead = flight.filter.Estimate(4.02);
  EXPECT_DOUBLE_EQ(ahead.t, 4.02);
  EXPECT_LT((ahead.p_WB - now.p_WB - 0.02 * now.v_WB).norm(), 0.02 * 0.02 * 10.0);
}

TEST(OwnStateFilter, EstimateLooksBackWithWhatIsKnownByNow) {
  OwnRig rig;
  rig.position_every = 0;
  OwnRun flight(3, 1.0, rig);
  flight.StartFromPrior();
  flight.FlyTo(4.0);
  const VehicleState then = flight.filter.Estimate();
  const OwnState truth = flight.True();
  flight.FlyTo(4.3);
  EXPECT_EQ(flight.filter.Estimate(4.0).p_WB, then.p_WB);
  EXPECT_DOUBLE_EQ(flight.filter.Estimate(4.1).t, 4.1);
  EXPECT_GT(flight.filter.Estimate(0.0).t, 2.0);  // as far as the history reaches
  OwnPositionFix fix;
  fix.t = 4.0;
  fix.p_WB = truth.p_WB;
  EXPECT_EQ(flight.filter.AddPosition(fix), OwnUpdate::kAcceptedLate);
  EXPECT_LT((flight.filter.Estimate(4.0).p_WB - truth.p_WB).norm(),
            0.5 * (then.p_WB - truth.p_WB).norm());
}

TEST(OwnStateFilter, TheSameInputsGiveTheSameBits) {
  OwnRig rig;
  rig.delay = 10;
  rig.velocity_every = 7;
  OwnRun a(11, 1.0, rig);
  OwnRun b(11, 1.0, rig);
  a.StartFromPrior();
  b.StartFromPrior();
  a.FlyTo(3.0);
  const OwnStateFilter copy = a.filter;
  a.FlyTo(5.0);
  b.FlyTo(5.0);
  EXPECT_EQ(a.filter.belief().cov, b.filter.belief().cov);
  EXPECT_EQ(a.filter.belief().state.p_WB, b.filter.belief().state.p_WB);
  EXPECT_LT(copy.belief().state.t, 3.1);  // a copy is independent
}

TEST(OwnStateFilter, InvalidMeasurementsAreCountedAndDoNothing) {
  OwnStateFilter filter;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(filter.AddPosition({0.0, {nan, 0.0, 0.0}, 0.1, 0.1}), OwnUpdate::kInvalid);
  EXPECT_EQ(filter.AddHeight({0.0, 1.0, -0.1}), OwnUpdate::kInvalid);
  EXPECT_EQ(filter.AddHeading({nan, 1.0, 0.1}), OwnUpdate::kInvalid);
  EXPECT_EQ(filter.AddImu({0.0, {0.0, 0.0, nan}, {0.0, 0.0, 0.0}}), OwnUpdate::kInvalid);
  EXPECT_EQ(filter.diagnostics().invalid, 4);
  EXPECT_FALSE(filter.started());
}

TEST(OwnStateFilter, ExactSensorsDoNotMakeItSingular) {
  OwnRun flight(3, 1.0, OwnRig{});
  flight.StartFromPrior();
  flight.FlyTo(1.0);
  for (int k = 0; k < 50; ++k) {
    flight.filter.AddPosition({1.0, flight.True().p_WB, 0.0, 0.0});
    flight.filter.AddHeading({1.0, Yaw(flight.True().q_WB), 0.0});
  }
  EXPECT_TRUE(flight.filter.belief().cov.allFinite());
  EXPECT_GT(flight.filter.belief().cov.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(),
            0.0);
}

TEST(OwnStateFilter, RefusesBadOptionsAndStarts) {
  OwnStateOptions options;
  options.max_delay = 6.0;
  try {
    const OwnStateFilter filter(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "OwnStateOptions.max_delay = 6, allowed: [0, 5]");
  }
  options = {};
  options.imu.gyro = 0.0;
  EXPECT_THROW(OwnStateFilter{options}, std::invalid_argument);
  options = {};
  options.reset_after = 1;
  EXPECT_THROW(OwnStateFilter{options}, std::invalid_argument);
  OwnStateFilter filter;
  VehicleState state;
  state.q_WB.coeffs() *= 2.0;
  EXPECT_THROW(filter.Start(state, {}), std::invalid_argument);
  OwnStartSigma sigma;
  sigma.yaw = 0.0;
  EXPECT_THROW(filter.Start({}, sigma), std::invalid_argument);
}

TEST(OwnStateFilter, EveryOutcomeHasANameAndEveryStatusASentence) {
  for (int i = 0; i <= static_cast<int>(OwnUpdate::kInvalid); ++i) {
    EXPECT_NE(ToString(static_cast<OwnUpdate>(i)), "unknown");
  }
  for (int i = 0; i <= static_cast<int>(OwnStatus::kImuStale); ++i) {
    EXPECT_NE(ToString(static_cast<OwnStatus>(i)), "unknown");
    EXPECT_THAT(std::string(Sentence(static_cast<OwnStatus>(i))), testing::EndsWith("."));
  }
  for (int i = 0; i < kOwnSensors; ++i) {
    EXPECT_NE(ToString(static_cast<OwnSensor>(i)), "unknown");
  }
}

}  // namespace
}  // namespace touchdown::estimation
