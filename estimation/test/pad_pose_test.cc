// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/tags/pad_pose.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "estimation/test/pad_image.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::estimation {
namespace {

const std::vector<int> kAll = {0, 1, 2, 3, 4};

PoseCP RandomPose(std::mt19937_64* random, double least, double most) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto draw = [&](double low, double high) { return low + (high - low) * unit(*random); };
  const double distance = draw(least, most);
  const double tilt = draw(0.0, 0.5);
  const double direction = draw(-3.1, 3.1);
  const double yaw = draw(-3.1, 3.1);
  const double x = draw(-0.4, 0.4);
  return PadAhead(distance, tilt, direction, yaw, {x, draw(-0.3, 0.3)});
}

TEST(PadReprojection, JacobiansAreThoseOfDifferences) {
  std::mt19937_64 random(1);
  const CameraIntrinsics camera = TestCamera();
  for (int trial = 0; trial < 20; ++trial) {
    const PoseCP pose = RandomPose(&random, 0.8, 5.0);
    const PadCorners corners(Detections(pose, camera, kAll, 1.0, &random));
    const PadNormal normal{Eigen::Vector3d(0.1, -0.2, -1.0).normalized(), 0.02};
    constexpr double kStep = 1e-6;
    for (int axis = 0; axis < 6; ++axis) {
      const Vector6d step = kStep * Vector6d::Unit(axis);
      const auto differs = [&](const auto& residual_at) {
        const auto here = residual_at(pose);
        const Eigen::Vector2d slope =
            (residual_at(pose.Moved(step)).offset - residual_at(pose.Moved(-step)).offset) /
            (2.0 * kStep);
        return (slope - here.jacobian.col(axis)).norm() / (1.0 + slope.norm());
      };
      for (int i = 0; i < corners.count; ++i) {
        EXPECT_LT(differs([&](const PoseCP& at) { return *ResidualOf(corners, i, at, camera); }),
                  1e-6);
      }
      EXPECT_LT(differs([&](const PoseCP& at) { return ResidualOf(normal, at); }), 1e-6);
    }
  }
}

TEST(PadPose, ExactCornersGiveTheExactPose) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const PoseCP truth = RandomPose(&random, 0.8, 6.0);
    for (const std::vector<int>& ids : {kAll, {0}, {3}, {1, 2}, {0, 4}}) {
      const PadPose pose = SolvePadPose(Detections(truth, TestCamera(), ids), TestCamera());
      ASSERT_EQ(pose.status, PadPoseStatus::kSolved) << Sentence(pose.status);
      EXPECT_LT(ErrorOf(truth, pose).norm(), 1e-6) << trial << " tags " << ids.size();
      EXPECT_EQ(pose.tags_used, static_cast<int>(ids.size()));
      EXPECT_EQ(pose.dropped_id, -1);
    }
  }
}

// Mean error and mean NEES of many noisy images from random places.
struct Figures {
  Vector6d normalised_mean = Vector6d::Zero();  ///< of the errors over their standard deviations
  double nees = 0.0;                            ///< mean over the 6 degrees of freedom
  int solved = 0;
};

Figures MonteCarlo(const std::vector<int>& ids, double least, double most, double normal_sigma,
                   int runs) {
  constexpr double kSigma = 0.15;
  std::mt19937_64 random(3);
  std::normal_distribution<double> gauss;
  PadPoseOptions options;
  options.corner_sigma = kSigma;
  Figures figures;
  for (int run = 0; run < runs; ++run) {
    const PoseCP truth = RandomPose(&random, least, most);
    std::optional<PadNormal> normal;
    if (normal_sigma > 0.0) {
      const Eigen::Vector3d turn{normal_sigma * gauss(random), normal_sigma * gauss(random),
                                 normal_sigma * gauss(random)};
      normal = PadNormal{Eigen::AngleAxisd(turn.norm(), turn.normalized()) * truth.R.col(2),
                         normal_sigma};
    }
    const PadPose pose = SolvePadPose(Detections(truth, TestCamera(), ids, kSigma, &random),
                                      TestCamera(), options, normal);
    if (pose.status != PadPoseStatus::kSolved) continue;
    ++figures.solved;
    const Vector6d error = ErrorOf(truth, pose);
    figures.nees += error.dot(pose.cov.ldlt().solve(error)) / 6.0;
    figures.normalised_mean += (error.array() / pose.cov.diagonal().array().sqrt()).matrix();
  }
  figures.nees /= figures.solved;
  figures.normalised_mean /= figures.solved;
  return figures;
}

void ExpectHonest(const Figures& figures, int runs, double slack) {
  EXPECT_GE(figures.solved, runs - runs / 100);
  const boost::math::chi_squared law(6.0 * figures.solved);
  EXPECT_GT(figures.nees, quantile(law, 0.025) / (6.0 * figures.solved));
  EXPECT_LT(figures.nees, slack * quantile(law, 0.975) / (6.0 * figures.solved));
  // Each of six means stays within 3.5 of its standard deviations.
  EXPECT_LT(figures.normalised_mean.cwiseAbs().maxCoeff(), 3.5 / std::sqrt(figures.solved));
}

TEST(PadPose, NoBiasAndHonestCovarianceOfTheWholePad) {
  ExpectHonest(MonteCarlo(kAll, 0.8, 5.0, 0.0, 1000), 1000, 1.0);
  ExpectHonest(MonteCarlo({1, 2}, 0.8, 3.0, 0.0, 1000), 1000, 1.0);
}

TEST(PadPose, NoBiasAndHonestCovarianceWithAKnownNormal) {
  // One tag alone has few residuals to estimate the noise, and its corners are not linear.
  ExpectHonest(MonteCarlo({0}, 0.4, 1.2, 0.02, 1000), 1000, 1.1);
  ExpectHonest(MonteCarlo({2}, 1.0, 3.0, 0.02, 1000), 1000, 1.1);
}

TEST(PadPose, SmallTagIsAmbiguousUntilTheNormalIsKnown) {
  std::mt19937_64 random(4);
  PadPoseOptions options;
  options.corner_sigma = 0.15;
  int ambiguous = 0;
  int wrong = 0;
  int unforeseen = 0;
  for (int run = 0; run < 200; ++run) {
    const PoseCP truth = PadAhead(2.0, 0.3, 0.05 * run, 0.3 * run);
    const auto tags = Detections(truth, TestCamera(), {0}, 0.15, &random);
    const PadPose alone = SolvePadPose(tags, TestCamera(), options);
    ASSERT_EQ(alone.status, PadPoseStatus::kSolved);
    if (alone.other_probability > 0.05) ++ambiguous;
    const Vector6d error = ErrorOf(truth, alone);
    if (error.tail<3>().norm() > 0.3) ++wrong;
    // The covariance has room for the other pose, as often as that is the true one.
    const double spread = std::sqrt(alone.cov.bottomRightCorner<3, 3>().trace());
    if (error.tail<3>().norm() > 4.5 * spread) ++unforeseen;
    const PadPose told = SolvePadPose(tags, TestCamera(), options, PadNormal{truth.R.col(2), 0.02});
    ASSERT_EQ(told.status, PadPoseStatus::kSolved);
    EXPECT_LT(ErrorOf(truth, told).tail<2>().norm(), 0.15);
    EXPECT_LT(told.other_probability, 1e-3);
    EXPECT_LT(told.cov.trace(), alone.cov.trace());
  }
  EXPECT_GT(ambiguous, 20);
  EXPECT_GT(wrong, 10);
  EXPECT_LE(unforeseen, 4);
}

TEST(PadPose, DropsOneTagThatDoesNotFit) {
  std::mt19937_64 random(5);
  const PoseCP truth = PadAhead(2.0, 0.2, 1.0, 0.5);
  auto tags = Detections(truth, TestCamera(), kAll, 0.1, &random);
  tags[3].corners.colwise() += Eigen::Vector2d(6.0, -4.0);
  const PadPose pose = SolvePadPose(tags, TestCamera());
  ASSERT_EQ(pose.status, PadPoseStatus::kSolved);
  EXPECT_EQ(pose.dropped_id, 3);
  EXPECT_EQ(pose.tags_used, 4);
  EXPECT_LT((pose.p_CP - truth.p).norm(), 0.02);

  tags[1].corners.colwise() += Eigen::Vector2d(-20.0, 30.0);
  EXPECT_EQ(SolvePadPose(tags, TestCamera()).status, PadPoseStatus::kInconsistent);
}

TEST(PadPose, NothingThatAnImageHoldsMakesItThrow) {
  const CameraIntrinsics camera = TestCamera();
  EXPECT_EQ(SolvePadPose({}, camera).status, PadPoseStatus::kNoTag);
  TagDetection tag;  // all corners in one point
  EXPECT_EQ(SolvePadPose(std::vector{tag}, camera).status, PadPoseStatus::kDegenerate);
  tag.corners << 10, 20, 30, 40, 10, 20, 30, 40;  // on a line
  EXPECT_EQ(SolvePadPose(std::vector{tag}, camera).status, PadPoseStatus::kDegenerate);
  tag.corners(0, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(SolvePadPose(std::vector{tag}, camera).status, PadPoseStatus::kDegenerate);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> anywhere(-50.0, 400.0);
  for (int run = 0; run < 500; ++run) {
    std::vector<TagDetection> tags = Detections({}, camera, {});
    for (int id = 0; id <= run % 5; ++id) {
      tag.id = id;
      for (double& coordinate : tag.corners.reshaped()) coordinate = anywhere(random);
      tags.push_back(tag);
    }
    const PadPose pose = SolvePadPose(tags, camera);
    if (pose.status == PadPoseStatus::kSolved) {
      EXPECT_TRUE(pose.cov.allFinite());
    }
    EXPECT_STRNE(Sentence(pose.status), "unknown");
  }
}

TEST(PadPose, RefusesTheCallersMistakes) {
  const auto tags = Detections(PadAhead(2, 0, 0, 0), TestCamera(), {0});
  const auto message = [&](auto change) -> std::string {
    auto some = tags;
    PadPoseOptions options;
    PadNormal normal;
    change(&some, &options, &normal);
    try {
      SolvePadPose(some, TestCamera(), options, normal);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  using Tags = std::vector<TagDetection>;
  EXPECT_EQ(message([](Tags*, PadPoseOptions*, PadNormal*) {}), "");
  EXPECT_THAT(message([](Tags* t, PadPoseOptions*, PadNormal*) { t->front().id = 5; }),
              ::testing::HasSubstr("tag id is 5; allowed is 0 to 4"));
  EXPECT_THAT(message([](Tags*, PadPoseOptions* o, PadNormal*) { o->corner_sigma = 0.0; }),
              ::testing::HasSubstr("corner_sigma is 0"));
  EXPECT_THAT(message([](Tags*, PadPoseOptions*, PadNormal* n) { n->sigma = -1.0; }),
              ::testing::HasSubstr("normal is -1"));
  EXPECT_THROW(ToSighting(PadPose{}, 0.0, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()),
               std::invalid_argument);
}

TEST(PadPose, SightingIsInTheBodyFrame) {
  // A level vehicle 2 m above a pad that is 0.3 m ahead and 0.2 m to the left, turned by 0.7.
  const Eigen::Matrix3d R_BC = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const Eigen::Vector3d p_BC(0.05, 0.0, -0.05);
  const Eigen::Vector3d p_BP(0.3, 0.2, -2.0);
  PoseCP truth;
  truth.p = R_BC.transpose() * (p_BP - p_BC);
  truth.R = R_BC.transpose() * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
  std::mt19937_64 random(7);
  const int runs = 500;
  double position = 0.0;
  double yaw = 0.0;
  for (int run = 0; run < runs; ++run) {
    const PadPose pose =
        SolvePadPose(Detections(truth, TestCamera(), kAll, 0.1, &random), TestCamera());
    const PadSighting sighting = ToSighting(pose, 1.5, R_BC, p_BC);
    EXPECT_EQ(sighting.t, 1.5);
    EXPECT_EQ(sighting.tags_seen, 5);
    position += ((sighting.p_BP_B - p_BP).array() / sighting.sigma_p.array()).square().mean();
    yaw += std::pow(WrapAngle(sighting.yaw_BP - 0.7) / sighting.sigma_yaw, 2);
  }
  EXPECT_NEAR(position / runs, 1.0, 0.15);
  EXPECT_NEAR(yaw / runs, 1.0, 0.2);

  const PadNormal normal = LevelPadNormal(Eigen::Matrix3d::Identity(), R_BC, 0.01);
  EXPECT_TRUE(normal.z_P_C.isApprox(truth.R.col(2)));
}

}  // namespace
}  // namespace touchdown::estimation
