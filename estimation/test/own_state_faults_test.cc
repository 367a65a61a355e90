// SPDX-License-Identifier: BSD-3-Clause
// OwnStateFilter under outage, outliers, delay, gaps and jumps.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "estimation/test/own_flight.h"

namespace touchdown::estimation {
namespace {

double MeanSquarePosition(const OwnRig& rig, int runs, OwnDiagnostics* counts = nullptr,
                          int* outliers = nullptr) {
  double sum = 0.0;
  int samples = 0;
  for (int run = 0; run < runs; ++run) {
    OwnRun flight(300 + static_cast<unsigned>(run), 1.0, rig);
    flight.StartFromPrior();
    for (double t = 4.0; t <= 10.0; t += 0.3) {
      flight.FlyTo(t);
      sum += flight.Error().head<3>().squaredNorm();
      ++samples;
    }
    const OwnDiagnostics one = flight.filter.diagnostics();
    EXPECT_EQ(one.resets, 0) << run;
    if (counts != nullptr) {
      counts->of(OwnSensor::kPosition).accepted += one.of(OwnSensor::kPosition).accepted;
      counts->of(OwnSensor::kPosition).gated += one.of(OwnSensor::kPosition).gated;
    }
    if (outliers != nullptr) *outliers += flight.outliers;
  }
  return sum / samples;
}

TEST(OwnStateFaults, OutageOfTwoSecondsStaysWithinItsCovariance) {
  OwnRig rig;
  rig.outage_begin = 6.05;
  rig.outage_end = 8.05;
  const int runs = 100;
  double nees = 0.0;
  double error2 = 0.0;
  double claimed = 0.0;
  double after2 = 0.0;
  for (unsigned run = 0; run < runs; ++run) {
    OwnRun flight(100 + run, 1.0, rig);
    flight.StartFromPrior();
    flight.FlyTo(6.4);
    EXPECT_EQ(flight.filter.Status(6.4), OwnStatus::kGood);
    flight.FlyTo(8.04);
    EXPECT_EQ(flight.filter.Status(8.04), OwnStatus::kOutage);
    nees += flight.Nees(kPositionError, 3);
    error2 += flight.Error().head<2>().squaredNorm() / runs;
    claimed += flight.filter.belief().cov.diagonal().head<2>().sum() / runs;
    flight.FlyTo(9.0);
    EXPECT_EQ(flight.filter.Status(9.0), OwnStatus::kGood);
    after2 += flight.Error().head<2>().squaredNorm() / runs;
  }
  const boost::math::chi_squared law(3 * runs);
  RecordProperty("rms_end_m", std::to_string(std::sqrt(error2)));
  RecordProperty("claimed_end_m", std::to_string(std::sqrt(claimed)));
  RecordProperty("rms_1s_after_m", std::to_string(std::sqrt(after2)));
  EXPECT_LT(nees, quantile(law, 0.975));
  EXPECT_LT(std::sqrt(error2), 0.5);
  EXPECT_LT(std::sqrt(after2), 0.1);
}

TEST(OwnStateFaults, OneOutlierInTenFixesDoesNotDiverge) {
  OwnRig rig;
  const double clean = MeanSquarePosition(rig, 50);
  rig.outlier_share = 0.1;
  OwnDiagnostics counts;
  int outliers = 0;
  const double with = MeanSquarePosition(rig, 50, &counts, &outliers);
  RecordProperty("rms_clean_m", std::to_string(std::sqrt(clean)));
  RecordProperty("rms_outliers_m", std::to_string(std::sqrt(with)));
  RecordProperty("outliers", std::to_string(outliers));
  RecordProperty("gated", std::to_string(counts.of(OwnSensor::kPosition).gated));
  EXPECT_GE(counts.of(OwnSensor::kPosition).gated, outliers);
  EXPECT_LT(counts.of(OwnSensor::kPosition).gated, outliers + 50);  // of 5000: the gate's 0.1 %
  EXPECT_LT(std::sqrt(with), 1.2 * std::sqrt(clean));
}

TEST(OwnStateFaults, LateFixesAreNearlyAsGood) {
  OwnRig rig;
  const double on_time = MeanSquarePosition(rig, 50);
  rig.delay = 24;  // 96 ms, of a fix every 100 ms
  const double late = MeanSquarePosition(rig, 50);
  RecordProperty("rms_on_time_m", std::to_string(std::sqrt(on_time)));
  RecordProperty("rms_late_m", std::to_string(std::sqrt(late)));
  EXPECT_LT(std::sqrt(late), 1.25 * std::sqrt(on_time));
}

// Once the late fix is in, the belief is that of a filter that had it on time.
TEST(OwnStateFaults, LateIsTheSameAsOrdered) {
  OwnRig rig;
  rig.position_every = 0;
  OwnRun ordered(7, 1.0, rig);
  OwnRun late(7, 1.0, rig);
  ordered.StartFromPrior();
  late.StartFromPrior();
  ordered.FlyTo(1.0);
  late.FlyTo(1.0);
  OwnPositionFix fix;
  fix.t = 1.002;  // between two IMU samples, ahead of its own
  fix.p_WB = ordered.True().p_WB;
  EXPECT_EQ(ordered.filter.AddPosition(fix), OwnUpdate::kAccepted);
  ordered.FlyTo(1.3);
  late.FlyTo(1.3);
  EXPECT_EQ(late.filter.AddPosition(fix), OwnUpdate::kAcceptedLate);
  EXPECT_EQ(late.filter.diagnostics().late_accepted, 1);
  const OwnBelief& a = ordered.filter.belief();
  const OwnBelief& b = late.filter.belief();
  EXPECT_EQ(a.state.p_WB, b.state.p_WB);
  EXPECT_EQ(a.state.q_WB.coeffs(), b.state.q_WB.coeffs());
  EXPECT_EQ(a.cov, b.cov);
  fix.t = 0.7;
  EXPECT_EQ(late.filter.AddPosition(fix), OwnUpdate::kTooOld);
  fix.t = 1.6;
  EXPECT_EQ(late.filter.AddPosition(fix), OwnUpdate::kInvalid);
}

TEST(OwnStateFaults, AJumpThatStaysIsTakenOver) {
  OwnRig rig;
  OwnRun flight(4, 0.5, rig);
  flight.StartFromPrior();
  flight.FlyTo(5.0);
  VehicleState wrong = flight.filter.Estimate();
  wrong.p_WB += Eigen::Vector3d(30.0, 0.0, 0.0);
  flight.filter.Start(wrong, OwnStartSigma{});
  flight.FlyTo(12.0);
  EXPECT_GE(flight.filter.diagnostics().resets, 1);
  EXPECT_LT(flight.Error().head<2>().norm(), 0.3);
}

TEST(OwnStateFaults, AGapOfTheImuWidensTheBelief) {
  OwnRig rig;
  OwnRun flight(4, 0.0, rig);
  flight.StartFromPrior();
  flight.FlyTo(2.0);
  const double before = flight.filter.belief().cov(kVelocityError, kVelocityError);
  EXPECT_EQ(flight.filter.Status(2.1), OwnStatus::kImuStale);
  ImuSample sample;
  sample.t = 2.2;
  sample.f_B = {0.0, 0.0, kGravity};
  EXPECT_EQ(flight.filter.AddImu(sample), OwnUpdate::kAccepted);
  EXPECT_EQ(flight.filter.diagnostics().imu_gaps, 1);
  EXPECT_GT(flight.filter.belief().cov(kVelocityError, kVelocityError), before + 1.0);
  EXPECT_EQ(flight.filter.Status(2.2), OwnStatus::kUncertain);
  sample.t = 2.1;
  EXPECT_EQ(flight.filter.AddImu(sample), OwnUpdate::kTooOld);
}

// One reading must not turn the vehicle through all of it.
TEST(OwnStateFaults, AfterALongGapOfTheImuTheAttitudeIsThatFromBefore) {
  OwnRig rig;
  OwnRun flight(4, 0.0, rig);
  flight.StartFromPrior();
  flight.FlyTo(2.0);
  const VehicleState before = flight.filter.Estimate();
  ImuSample sample;
  sample.t = 12.0;
  sample.f_B = {0.0, 0.0, kGravity};
  sample.w_WB_B = {0.3, 0.0, 0.0};
  EXPECT_EQ(flight.filter.AddImu(sample), OwnUpdate::kAccepted);
  const VehicleState after = flight.filter.Estimate();
  EXPECT_LT(after.q_WB.angularDistance(before.q_WB), 0.02);
  EXPECT_LT((after.p_WB - before.p_WB - 10.0 * before.v_WB).norm(), 1.0);
  const auto& cov = flight.filter.belief().cov;
  EXPECT_GT(std::sqrt(cov(kAttitudeError, kAttitudeError)), 0.2);
  EXPECT_LT(std::sqrt(cov(kAttitudeError, kAttitudeError)), 0.4);
  EXPECT_GT(std::sqrt(cov(kPositionError, kPositionError)), 100.0);
}

}  // namespace
}  // namespace touchdown::estimation
