// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/tags/tag_detector.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "estimation/tags/enlarge.h"
#include "estimation/test/pad_image.h"

namespace touchdown::estimation {
namespace {

double WorstCorner(const std::vector<TagDetection>& found, const PoseCP& pose) {
  double worst = 0.0;
  for (const TagDetection& tag : found) {
    const auto exact = Detections(pose, TestCamera(), {tag.id});
    worst = std::max(worst, (tag.corners - exact.front().corners).colwise().norm().maxCoeff());
  }
  return worst;
}

TEST(TagDetector, FindsAllTagsWithTheirCornersInOrder) {
  TagDetector twice({.enlarge = 2});
  TagDetector once;
  for (const double yaw : {0.0, 0.4, 2.0, -2.7}) {
    const PoseCP pose = PadAhead(1.5, 0.2, 0.5, yaw, {0.05, -0.03});
    const GrayImage image = DrawPad(pose, TestCamera());
    for (TagDetector* detector : {&once, &twice}) {
      const auto found = detector->Detect(image.View());
      ASSERT_EQ(found.size(), 5U) << yaw;
      for (int id = 0; id < 5; ++id) EXPECT_EQ(found[static_cast<std::size_t>(id)].id, id);
      EXPECT_LT(WorstCorner(found, pose), 0.5) << yaw;
    }
  }
}

TEST(TagDetector, EnlargedImagesHaveTheirTagsFoundFartherAway) {
  TagDetector twice({.enlarge = 2});
  TagDetector once;
  const GrayImage image = DrawPad(PadAhead(7.5, 0.1, 0.5, 0.4), TestCamera());  // 10.7 pixels
  EXPECT_EQ(twice.Detect(image.View()).size(), 4U);
  EXPECT_LT(once.Detect(image.View()).size(), 4U);
}

TEST(TagDetector, CutTagsAreNotReported) {
  const PoseCP pose = PadAhead(1.5, 0.0, 0.0, 0.0, {0.8, 0.0});  // half of the pad is to the right
  const auto found = TagDetector().Detect(DrawPad(pose, TestCamera()).View());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].id, 2);
  EXPECT_EQ(found[1].id, 3);
  EXPECT_LT(WorstCorner(found, pose), 0.5);
}

TEST(TagDetector, NoCornerIsTakenFromTheBorder) {
  TagDetector detector;
  for (int step = 0; step < 40; ++step) {
    const PoseCP pose = PadAhead(0.8, 0.2, 0.1 * step, 0.7, {0.55 + 0.01 * step, 0.1});
    const auto found = detector.Detect(DrawPad(pose, TestCamera()).View());
    EXPECT_LT(WorstCorner(found, pose), 1.0) << step;
  }
}

TEST(TagDetector, NoiseIsNoTag) {
  std::mt19937 random(1);
  GrayImage image{320, 240, std::vector<std::uint8_t>(320 * 240)};
  TagDetector detector;
  for (int run = 0; run < 5; ++run) {
    const int cell = 1 << run;  // blocks of 1 to 16 pixels
    std::vector<std::uint8_t> blocks(320 * 240);
    for (std::uint8_t& level : blocks) level = static_cast<std::uint8_t>(random() % 256);
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        image.pixels[static_cast<std::size_t>(v * 320 + u)] =
            blocks[static_cast<std::size_t>(v / cell * 320 + u / cell)];
      }
    }
    EXPECT_TRUE(detector.Detect(image.View()).empty()) << cell;
  }
}

TEST(TagDetector, SameImageSameBits) {
  const GrayImage image = DrawPad(PadAhead(3.0, 0.3, 0.5, 0.4), TestCamera());
  TagDetector detector;
  const auto first = detector.Detect(image.View());
  const auto second = detector.Detect(image.View());
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].corners, second[i].corners);
  }
}

TEST(TagDetector, RefusesTheCallersMistakes) {
  EXPECT_THROW(TagDetector({.enlarge = 3}), std::invalid_argument);
  TagDetector detector;
  EXPECT_THROW(detector.Detect({}), std::invalid_argument);
  const std::vector<std::uint8_t> pixels(100);
  EXPECT_THROW(detector.Detect({pixels.data(), 10, 10, 9}), std::invalid_argument);
  EXPECT_THROW(detector.Detect({pixels.data(), 7, 10, 10}), std::invalid_argument);
  EXPECT_TRUE(detector.Detect({pixels.data(), 10, 10, 10}).empty());
}

TEST(Enlarge, KeepsRampsAndBorders) {
  GrayImage image{16, 12, std::vector<std::uint8_t>(16 * 12)};
  for (int v = 0; v < 12; ++v) {
    for (int u = 0; u < 16; ++u) {
      image.pixels[static_cast<std::size_t>(v * 16 + u)] =
          static_cast<std::uint8_t>(20 + 8 * u + 4 * v);
    }
  }
  GrayImage twice;
  EnlargeTwice(image.View(), &twice);
  ASSERT_EQ(twice.width, 32);
  ASSERT_EQ(twice.height, 24);
  for (int v = 4; v < 20; ++v) {
    for (int u = 4; u < 28; ++u) {
      const double expected = 20 + 8 * (0.5 * (u + 0.5) - 0.5) + 4 * (0.5 * (v + 0.5) - 0.5);
      EXPECT_NEAR(twice.pixels[static_cast<std::size_t>(v * 32 + u)], expected, 0.51);
    }
  }
  const GrayImage flat{9, 9, std::vector<std::uint8_t>(81, 200)};
  EnlargeTwice(flat.View(), &twice);
  for (const std::uint8_t level : twice.pixels) EXPECT_EQ(level, 200);
}

TEST(TagCode, IsWhatIsPrinted) {
  const TagCode code = TagCodeOf(0);
  for (int i = 0; i < kTagCells; ++i) {
    EXPECT_EQ(code[0][static_cast<std::size_t>(i)], 255);
    EXPECT_EQ(code[static_cast<std::size_t>(i)][9], 255);
  }
  for (std::size_t i = 1; i < 9; ++i) EXPECT_EQ(code[1][i], 0);
  EXPECT_THROW(TagCodeOf(-1), std::invalid_argument);
  EXPECT_THROW(TagCodeOf(100000), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::estimation
