// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/tags/pad_finder.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "estimation/tags/pad_sheet.h"
#include "estimation/test/pad_image.h"

namespace touchdown::estimation {
namespace {

TEST(SheetAverage, IsTheMeanOfThePrint) {
  const SheetAverage average;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-0.6, 0.6);
  for (int run = 0; run < 50; ++run) {
    const Eigen::Vector2d center(place(random), place(random));
    const Eigen::Vector2d half(0.004 + 0.02 * run / 50.0, 0.03);
    double sum = 0.0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        sum += PadLevel(center +
                        Eigen::Vector2d((2 * i + 1.0) / kSteps - 1.0, (2 * j + 1.0) / kSteps - 1.0)
                            .cwiseProduct(half));
      }
    }
    EXPECT_NEAR(average.Over(center, half), sum / (kSteps * kSteps), 1.5);
  }
  EXPECT_NEAR(average.Over({2.0, 0.0}, {0.1, 0.1}), 255.0, 1e-3);
}

void AddNoise(double sigma, std::mt19937_64* random, GrayImage* image) {
  std::normal_distribution<double> normal(0.0, sigma);
  for (std::uint8_t& level : image->pixels) {
    level = static_cast<std::uint8_t>(std::clamp(std::lround(level + normal(*random)), 0L, 255L));
  }
}

TEST(PadFinder, AlignmentMakesFarPosesSharperAndStaysHonest) {
  PadFinder whole;
  PadFinderOptions options;
  options.align = false;
  PadFinder corners(options);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<double> sharp, plain;
  double nees = 0.0;
  int aligned = 0;
  constexpr int kRuns = 25;
  for (int run = 0; run < kRuns; ++run) {
    const double distance = 6.0 + 1.5 * unit(random), tilt = 0.2 + 0.2 * unit(random);
    const double direction = 3.0 * unit(random), yaw = 3.0 * unit(random);
    const PoseCP truth =
        PadAhead(distance, tilt, direction, yaw, {0.3 * unit(random), 0.2 * unit(random)});
    GrayImage image = DrawPad(truth, TestCamera());
    AddNoise(2.0, &random, &image);
    const PadNormal normal{truth.R.col(2), 0.02};
    const PadView view = whole.Find(image.View(), TestCamera(), normal);
    const PadView before = corners.Find(image.View(), TestCamera(), normal);
    ASSERT_EQ(view.pose.status, PadPoseStatus::kSolved) << run;
    ASSERT_FALSE(before.aligned);
    if (!view.aligned) continue;
    ++aligned;
    const Vector6d error = ErrorOf(truth, view.pose);
    sharp.push_back(error.head<3>().norm());
    plain.push_back(ErrorOf(truth, before.pose).head<3>().norm());
    nees += error.dot(view.pose.cov.ldlt().solve(error)) / 6.0;
  }
  ASSERT_GE(aligned, kRuns - 2);
  std::sort(sharp.begin(), sharp.end());
  std::sort(plain.begin(), plain.end());
  EXPECT_LT(sharp[sharp.size() / 2], 0.010);
  EXPECT_LT(sharp[sharp.size() / 2], 0.5 * plain[plain.size() / 2]);
  EXPECT_LT(nees / aligned, 1.5);
}

TEST(PadFinder, PoseIsLeftAloneWhereTheSheetIsNot) {
  const PoseCP truth = PadAhead(4.0, 0.2, 1.0, 0.5);
  PadPose pose = SolvePadPose(Detections(truth, TestCamera(), {0, 1, 2, 3, 4}), TestCamera());
  ASSERT_EQ(pose.status, PadPoseStatus::kSolved);
  const PadPose before = pose;
  PadAlignment alignment;
  std::mt19937 random(1);
  GrayImage image{320, 240, std::vector<std::uint8_t>(320 * 240, 100)};
  EXPECT_FALSE(alignment.Refine(image.View(), TestCamera(), std::nullopt, &pose));
  for (std::uint8_t& level : image.pixels) level = static_cast<std::uint8_t>(random() % 256);
  EXPECT_FALSE(alignment.Refine(image.View(), TestCamera(), std::nullopt, &pose));
  image = DrawPad(PadAhead(4.0, 0.2, 1.0, 0.5 + 1.6), TestCamera());  // turned too far
  EXPECT_FALSE(alignment.Refine(image.View(), TestCamera(), std::nullopt, &pose));
  EXPECT_EQ(pose.p_CP, before.p_CP);
  EXPECT_EQ(pose.cov, before.cov);
  PadPose none;
  EXPECT_FALSE(alignment.Refine(image.View(), TestCamera(), std::nullopt, &none));
}

TEST(PadFinder, HalfThePadOccluded) {
  const PoseCP truth = PadAhead(3.0, 0.2, 1.0, 0.3);
  GrayImage image = DrawPad(truth, TestCamera());
  for (int v = 0; v < image.height; ++v) {
    for (int u = 162; u < image.width; ++u) {
      image.pixels[static_cast<std::size_t>(v * image.width + u)] = 60;
    }
  }
  PadFinder finder;
  const PadView view = finder.Find(image.View(), TestCamera(), PadNormal{truth.R.col(2), 0.02});
  ASSERT_EQ(view.pose.status, PadPoseStatus::kSolved);
  EXPECT_EQ(view.tags.size(), 2U);
  const Vector6d error = ErrorOf(truth, view.pose);
  EXPECT_LT(error.head<3>().norm(), 0.03);
  EXPECT_LT(error.dot(view.pose.cov.ldlt().solve(error)), 30.0);
}

TEST(PadAlignment, RefusesBadOptions) {
  EXPECT_THROW(PadAlignment({.blur = 0.5}), std::invalid_argument);
  EXPECT_THROW(PadAlignment({.correlation = 1.5}), std::invalid_argument);
  EXPECT_THROW(PadAlignment({.neighbors = std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::estimation
