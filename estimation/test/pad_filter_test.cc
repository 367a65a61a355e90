// SPDX-License-Identifier: BSD-3-Clause
// Behaviour of the pad filter on drives that its own model does not produce, and its handling of
// outliers, outages, late and broken measurements.
#include "touchdown/estimation/pad/pad_filter.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimation/test/pad_drive.h"
#include "touchdown/estimation/pad/pad_predictor.h"

namespace touchdown::estimation {
namespace {

PadFilterOptions With(PadModel model) {
  PadFilterOptions options;
  options.model = model;
  return options;
}

class BothModels : public testing::TestWithParam<PadModel> {};
INSTANTIATE_TEST_SUITE_P(PadFilter, BothModels,
                         testing::Values(PadModel::kPaper, PadModel::kTurnRate),
                         [](const auto& model) { return std::string(ToString(model.param)); });

TEST_P(BothModels, ConvergesWithinHalfASecond) {
  const std::vector<PadDrive> drives = {StraightDrive(2.0), CircleDrive(2.0)};
  for (const PadDrive& drive : drives) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      std::mt19937_64 random(seed);
      PadFilter filter(With(GetParam()));
      FeedGps(filter, drive, 0.0, 0.5, 0.01, random);
      ASSERT_TRUE(filter.Converged(0.5));
      ASSERT_TRUE(filter.heading_known());
      EXPECT_LT(PositionError(filter.Estimate(0.5), drive.At(0.5)), 0.05) << seed;
      EXPECT_LT(VelocityError(filter.Estimate(0.5), drive.At(0.5)), 0.15) << seed;
    }
  }
}

TEST_P(BothModels, FollowsEveryDrive) {
  const std::vector<PadDrive> drives = {StraightDrive(14.0), CircleDrive(14.0),
                                        StraightTurnDrive(14.0), StandingDrive(14.0),
                                        ReversingDrive(14.0)};
  for (std::size_t d = 0; d < drives.size(); ++d) {
    std::mt19937_64 random(11);
    PadFilter filter(With(GetParam()));
    double squares = 0.0;
    double worst = 0.0;
    const int fixes = 120;
    for (int k = 0; k < fixes; ++k) {
      const double t = 0.1 * k;
      filter.AddGps(GpsFix(drives[d], t, 0.01, random));
      const double error = PositionError(filter.Estimate(t), drives[d].At(t));
      squares += error * error;
      worst = std::max(worst, error);
    }
    EXPECT_LT(std::sqrt(squares / fixes), 0.025) << "drive " << d;
    EXPECT_LT(worst, 0.12) << "drive " << d;
    EXPECT_LT(VelocityError(filter.Estimate(11.9), drives[d].At(11.9)), 0.2) << "drive " << d;
  }
}

TEST_P(BothModels, TagTellsForwardFromBackward) {
  const PadDrive drive(
      PadStart(0, 0, -0.5, 1.0), [](double) { return -0.5; }, [](double) { return 0.0; }, 6.0);
  std::mt19937_64 random(5);
  PadFilter filter(With(GetParam()));
  FeedGps(filter, drive, 0.0, 2.0, 0.01, random);
  // From its motion alone the pad seems to drive forward.
  EXPECT_NEAR(std::abs(WrapAngle(filter.Estimate(2.0).yaw - 1.0)), std::numbers::pi, 0.2);
  const Eigen::Vector3d v_before = filter.Estimate(2.0).v_WP;
  FeedGpsAndTags(filter, drive, 2.1, 3.1, 0.01, random);
  EXPECT_NEAR(WrapAngle(filter.Estimate(3.1).yaw - 1.0), 0.0, 0.05);
  EXPECT_LT(filter.belief().mean(2), -0.4);
  EXPECT_LT((filter.Estimate(3.1).v_WP - v_before).norm(), 0.1);
  EXPECT_EQ(filter.diagnostics().restarts, 0);
}

TEST_P(BothModels, StandingPadWithTagsHasAHeading) {
  const PadDrive drive = StandingDrive(20.0);
  std::mt19937_64 random(6);
  PadFilter filter(With(GetParam()));
  FeedGpsAndTags(filter, drive, 0.0, 15.0, 0.5, random);
  EXPECT_TRUE(filter.heading_known());
  EXPECT_LT(PositionError(filter.Estimate(15.0), drive.At(15.0)), 0.02);
  EXPECT_LT(VelocityError(filter.Estimate(15.0), drive.At(15.0)), 0.05);
  EXPECT_NEAR(filter.Estimate(15.0).yaw, 1.0, 0.05);
}

// What a camera sees of a level pad is seen from a body that leans: the heading is that of the level one.
TEST_P(BothModels, ALeaningVehicleSeesTheHeadingOfTheLevelPad) {
  const PadDrive drive = StandingDrive(1.0);
  std::mt19937_64 random(8);
  for (const double lean : {0.0, 0.3, 0.6, -0.6}) {
    VehicleState vehicle = Onlooker(drive, 0.0, 1.5);
    vehicle.q_WB = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(lean, Eigen::Vector3d(0.6, 0.8, 0.0));
    PadSighting sighting = Sighting(drive, vehicle, 0.0, 0.0, random);
    sighting.sigma_p.setConstant(1e-3);
    sighting.sigma_yaw = 1e-3;
    PadFilter filter(With(GetParam()));
    EXPECT_EQ(filter.AddSighting(sighting, vehicle), PadUpdate::kInitialized);
    EXPECT_NEAR(filter.Estimate(0.0).yaw, 1.0, 1e-9) << lean;
  }
}

TEST_P(BothModels, HeadingIsGivenUpAtStandstillAndFoundAgain) {
  const PadDrive drive(
      PadStart(0, 0, 0.8, 0.0), [](double t) { return t < 2.0 || t > 60.0 ? 0.8 : 0.0; },
      [](double) { return 0.0; }, 70.0);
  std::mt19937_64 random(7);
  PadFilter filter(With(GetParam()));
  FeedGps(filter, drive, 0.0, 2.0, 0.01, random);
  EXPECT_TRUE(filter.heading_known());
  FeedGps(filter, drive, 2.1, 59.9, 0.01, random);
  EXPECT_FALSE(filter.heading_known());
  EXPECT_LT(PositionError(filter.Estimate(59.9), drive.At(59.9)), 0.05);
  FeedGps(filter, drive, 60.0, 63.0, 0.01, random);
  EXPECT_TRUE(filter.heading_known());
  EXPECT_NEAR(filter.Estimate(63.0).yaw, 0.0, 0.2);
  EXPECT_LT(VelocityError(filter.Estimate(63.0), drive.At(63.0)), 0.15);
}

TEST_P(BothModels, OutliersAreGated) {
  const PadDrive drive = StraightDrive(10.0);
  std::mt19937_64 random(8);
  PadFilter filter(With(GetParam()));
  FeedGps(filter, drive, 0.0, 4.0, 0.01, random);
  const PadBelief before = filter.BeliefAt(4.1);
  const int gated_before = filter.diagnostics().gps_gated;
  PadGpsFix wild = GpsFix(drive, 4.1, 0.01, random);
  wild.p_WP.x() += 3.0;
  EXPECT_EQ(filter.AddGps(wild), PadUpdate::kGated);
  EXPECT_EQ(filter.belief().mean, before.mean);
  wild.t = 4.2;
  EXPECT_EQ(filter.AddGps(wild), PadUpdate::kGated);  // too wild for a manoeuvre, too
  EXPECT_EQ(filter.diagnostics().gps_gated, gated_before + 2);
  EXPECT_EQ(filter.AddGps(GpsFix(drive, 4.3, 0.01, random)), PadUpdate::kAccepted);
  EXPECT_LT(PositionError(filter.Estimate(4.3), drive.At(4.3)), 0.04);
}

TEST_P(BothModels, RestartsAfterLastingDisagreement) {
  const PadDrive drive = StraightDrive(30.0);
  std::mt19937_64 random(9);
  PadFilter filter(With(GetParam()));
  FeedGps(filter, drive, 0.0, 4.0, 0.01, random);
  // The pad was somewhere else all the time.
  int gated = 0;
  double t = 4.0;
  PadUpdate update = PadUpdate::kGated;
  while (update == PadUpdate::kGated && gated < 20) {
    t += 0.1;
    PadGpsFix fix = GpsFix(drive, t, 0.01, random);
    fix.p_WP.y() += 5.0;
    update = filter.AddGps(fix);
    gated += update == PadUpdate::kGated ? 1 : 0;
  }
  EXPECT_EQ(update, PadUpdate::kInitialized);
  EXPECT_EQ(gated, filter.options().restart_after - 1);
  EXPECT_EQ(filter.diagnostics().restarts, 1);
  EXPECT_NEAR(filter.Estimate(t).p_WP.y(), drive.At(t)(1) + 5.0, 0.05);
}

TEST_P(BothModels, RecoversFromAnOutage) {
  const PadDrive drive = CircleDrive(30.0);
  std::mt19937_64 random(10);
  PadFilter filter(With(GetParam()));
  FeedGps(filter, drive, 0.0, 5.0, 0.01, random);
  FeedGps(filter, drive, 15.0, 16.5, 0.01, random);
  EXPECT_LT(PositionError(filter.Estimate(16.5), drive.At(16.5)), 0.05);
  EXPECT_LT(VelocityError(filter.Estimate(16.5), drive.At(16.5)), 0.2);
}

TEST_P(BothModels, LateMeasurementsCountAsIfInOrder) {
  const PadDrive drive = CircleDrive(10.0);
  std::mt19937_64 random(12);
  std::vector<PadGpsFix> fixes;
  for (int k = 0; k < 60; ++k) fixes.push_back(GpsFix(drive, 0.1 * k, 0.05, random));
  PadFilter ordered(With(GetParam()));
  PadFilter late(With(GetParam()));
  for (const PadGpsFix& fix : fixes) ordered.AddGps(fix);
  // Every fourth one arrives three places late.
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    if (k % 4 != 0) late.AddGps(fixes[k]);
    if (k % 4 == 3) {
      EXPECT_NE(late.AddGps(fixes[k - 3]), PadUpdate::kTooOld);
    }
  }
  EXPECT_EQ(late.belief().mean, ordered.belief().mean);
  EXPECT_EQ(late.belief().cov, ordered.belief().cov);
  EXPECT_GT(late.diagnostics().late_accepted, 10);
  EXPECT_EQ(late.diagnostics().gps_accepted, ordered.diagnostics().gps_accepted);
}

TEST_P(BothModels, TooOldIsRefusedWithoutEffect) {
  const PadDrive drive = CircleDrive(10.0);
  std::mt19937_64 random(13);
  PadFilter filter(With(GetParam()));
  FeedGps(filter, drive, 0.0, 8.0, 0.05, random);
  const PadBelief before = filter.belief();
  EXPECT_EQ(filter.AddGps(GpsFix(drive, 7.0, 0.05, random)), PadUpdate::kTooOld);
  EXPECT_EQ(filter.belief().mean, before.mean);
  EXPECT_EQ(filter.diagnostics().too_old, 1);
}

// Also while the buffer has room.
TEST_P(BothModels, TooOldIsRefusedFromTheFirstFixesOn) {
  PadFilter filter(With(GetParam()));
  for (int k = 0; k < 5; ++k) filter.AddGps({10.0 + 0.1 * k, Eigen::Vector2d(1.0, 2.0), 0.1});
  EXPECT_EQ(filter.AddGps({9.0, Eigen::Vector2d(1.0, 2.0), 0.1}), PadUpdate::kTooOld);
  EXPECT_EQ(filter.diagnostics().too_old, 1);
}

TEST_P(BothModels, LateAtHighRateIsRefusedBeyondTheBuffer) {
  PadFilter filter(With(GetParam()));
  for (int k = 0; k < 500; ++k) filter.AddGps({0.001 * k, Eigen::Vector2d(1.0, 2.0), 0.1});
  EXPECT_EQ(filter.AddGps({0.1, Eigen::Vector2d(1.0, 2.0), 0.1}), PadUpdate::kTooOld);
  EXPECT_EQ(filter.AddGps({0.4985, Eigen::Vector2d(1.0, 2.0), 0.1}), PadUpdate::kAcceptedLate);
}

TEST_P(BothModels, BrokenMeasurementsAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PadFilter filter(With(GetParam()));
  EXPECT_EQ(filter.AddGps({nan, Eigen::Vector2d::Zero(), 0.1}), PadUpdate::kInvalid);
  EXPECT_EQ(filter.AddGps({0.0, Eigen::Vector2d(nan, 0.0), 0.1}), PadUpdate::kInvalid);
  EXPECT_EQ(filter.AddGps({0.0, Eigen::Vector2d::Zero(), -0.1}), PadUpdate::kInvalid);
  EXPECT_EQ(filter.AddGps({0.0, Eigen::Vector2d::Zero(), nan}), PadUpdate::kInvalid);
  PadSighting sighting;
  EXPECT_EQ(filter.AddSighting(sighting, VehicleState{}), PadUpdate::kInvalid);
  sighting.sigma_p.setConstant(0.01);
  sighting.sigma_yaw = 0.01;
  sighting.p_BP_B.y() = nan;
  EXPECT_EQ(filter.AddSighting(sighting, VehicleState{}), PadUpdate::kInvalid);
  EXPECT_FALSE(filter.initialized());
  EXPECT_FALSE(filter.Converged(0.0));
  EXPECT_EQ(filter.diagnostics().invalid, 6);
  EXPECT_THROW(Predict(filter), std::invalid_argument);
}

TEST_P(BothModels, AnExactReceiverCountsAsOneOfAMillimetre) {
  PadFilter exact(With(GetParam()));
  PadFilter fine(With(GetParam()));
  for (int i = 0; i <= 50; ++i) {
    const double t = 0.1 * i;
    const Eigen::Vector2d p_WP(0.8 * t, 1.0);
    EXPECT_NE(exact.AddGps({t, p_WP, 0.0}), PadUpdate::kInvalid);
    fine.AddGps({t, p_WP, kLeastGpsSigma});
  }
  EXPECT_TRUE(exact.Converged(5.0));
  EXPECT_LT((exact.Estimate(5.0).p_WP.head<2>() - Eigen::Vector2d(4.0, 1.0)).norm(), 1e-3);
  EXPECT_EQ(exact.belief().mean, fine.belief().mean);
  EXPECT_EQ(exact.belief().cov, fine.belief().cov);
}

TEST_P(BothModels, CopiesAreIndependentAndDeterministic) {
  const PadDrive drive = CircleDrive(10.0);
  std::mt19937_64 random(14);
  PadFilter filter(With(GetParam()));
  FeedGps(filter, drive, 0.0, 3.0, 0.02, random);
  const BeliefPrediction prediction = Predict(filter);
  const PadState before = prediction.At(5.0);
  PadFilter copy = filter;
  std::mt19937_64 same = random;
  FeedGps(filter, drive, 3.1, 5.0, 0.02, random);
  EXPECT_DOUBLE_EQ(copy.belief().t, 3.0);
  EXPECT_EQ(prediction.At(5.0).p_WP, before.p_WP);
  FeedGps(copy, drive, 3.1, 5.0, 0.02, same);
  EXPECT_EQ(copy.belief().mean, filter.belief().mean);
  EXPECT_EQ(copy.belief().cov, filter.belief().cov);
}

TEST(PadFilter, PaperHandsOverFromGpsToTagsAtTwoMetres) {
  const PadDrive drive = StraightDrive(10.0);
  std::mt19937_64 random(15);
  PadFilter filter(With(PadModel::kPaper));
  FeedGps(filter, drive, 0.0, 2.0, 0.5, random);
  VehicleState vehicle = Onlooker(drive, 2.1, 1.5);
  filter.AddSighting(Sighting(drive, vehicle, 0.01, 0.02, random), vehicle);
  EXPECT_EQ(filter.AddGps(GpsFix(drive, 2.2, 0.5, random)), PadUpdate::kNotUsed);
  // Tags out of view for the time-out: GPS again.
  EXPECT_EQ(filter.AddGps(GpsFix(drive, 2.7, 0.5, random)), PadUpdate::kAccepted);
  // Tags from afar do not take over.
  vehicle = Onlooker(drive, 2.8, 3.0);
  filter.AddSighting(Sighting(drive, vehicle, 0.02, 0.02, random), vehicle);
  EXPECT_EQ(filter.AddGps(GpsFix(drive, 2.9, 0.5, random)), PadUpdate::kAccepted);
  EXPECT_DOUBLE_EQ(filter.TagAge(3.0), 3.0 - 2.8);
}

TEST(PadFilter, TagsSharpenPoorGps) {
  const PadDrive drive = StraightTurnDrive(12.0);
  std::mt19937_64 random(16);
  PadFilter filter;
  FeedGps(filter, drive, 0.0, 3.0, 1.0, random);
  EXPECT_GT(filter.PositionSigma(3.0), 0.08);
  FeedGpsAndTags(filter, drive, 3.1, 4.1, 1.0, random);
  EXPECT_LT(filter.PositionSigma(4.1), 0.02);
  EXPECT_LT(PositionError(filter.Estimate(4.1), drive.At(4.1)), 0.03);
  EXPECT_EQ(filter.diagnostics().restarts, 0);
}

// RMS error of the position predicted 1.5 s ahead on the circle of the paper's case 2.
double CirclePredictionError(PadModel model, bool tags) {
  const PadDrive drive = CircleDrive(14.0);
  double squares = 0.0;
  int count = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937_64 random(seed);
    PadFilter filter(With(model));
    for (int k = 0; k < 12; ++k) {
      if (tags) {
        FeedGpsAndTags(filter, drive, k, k + 0.98, 0.01, random);
      } else {
        FeedGps(filter, drive, k, k + 0.91, 0.01, random);
      }
      if (k < 2) continue;
      const double t = k + 0.9;
      const double error = PositionError(Predict(filter).At(t + 1.5), drive.At(t + 1.5));
      squares += error * error;
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(PadFilter, TurnRatePredictsACircleBetterThanThePaper) {
  const double paper = CirclePredictionError(PadModel::kPaper, true);
  const double turn_rate = CirclePredictionError(PadModel::kTurnRate, true);
  RecordProperty("paper_m", std::to_string(paper));
  RecordProperty("turn_rate_m", std::to_string(turn_rate));
  EXPECT_LT(turn_rate, paper / 2.5);
  // With GPS alone the speed's noise, which both models share, is a larger part of the error.
  const double paper_gps = CirclePredictionError(PadModel::kPaper, false);
  const double turn_rate_gps = CirclePredictionError(PadModel::kTurnRate, false);
  RecordProperty("paper_gps_m", std::to_string(paper_gps));
  RecordProperty("turn_rate_gps_m", std::to_string(turn_rate_gps));
  EXPECT_LT(turn_rate_gps, 0.5 * paper_gps);
}

TEST(PadFilter, DampedTurnRateHelpsOnStraights) {
  const PadDrive drive = StraightDrive(20.0);
  double damped = 0.0;
  double undamped = 0.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    PadFilter filter;
    for (int k = 0; k < 10; ++k) {
      FeedGps(filter, drive, k, k + 0.91, 0.01, random);
      const double t = k + 0.9;
      damped += std::pow(PositionError(Predict(filter).At(t + 3.0), drive.At(t + 3.0)), 2);
      undamped += std::pow(PositionError(filter.Estimate(t + 3.0), drive.At(t + 3.0)), 2);
    }
  }
  EXPECT_LT(damped, 0.8 * undamped);
}

TEST(PadFilter, NamesAndOptionsAreChecked) {
  EXPECT_EQ(PadModelFromName("paper"), PadModel::kPaper);
  EXPECT_EQ(PadModelFromName("turn_rate"), PadModel::kTurnRate);
  EXPECT_THROW(PadModelFromName("imm"), std::invalid_argument);
  PadFilterOptions options;
  options.noise.turn = -1.0;
  try {
    const PadFilter filter(options);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("noise.turn = -1, allowed: > 0"));
  }
}

}  // namespace
}  // namespace touchdown::estimation
