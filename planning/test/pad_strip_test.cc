// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/pad_strip.h"

#include <gtest/gtest.h>

#include "touchdown/planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

constexpr double kRadius = 0.8, kDeck = 0.3;

EndpointTarget AtHeight(double height) {
  EndpointTarget target;
  target.height = target.height_floor = height;
  return target;
}

TEST(PadStrip, CoversThePadFromStartToArrival) {
  const ArcPad pad({1.0, 2.0, kDeck}, 0.5, 0.0, 0.0);
  FreeSpace space;
  LayPadStrip(pad, AtHeight(1.0), {-5.0, 0.0, 2.0}, 1.0, 5.0, kRadius, &space);
  for (double t = 1.0; t <= 5.0; t += 0.25) {
    EXPECT_TRUE(space.OverPad(pad.At(t).p_WP)) << t;
    EXPECT_FALSE(space.OverPad(pad.At(t).p_WP + Eigen::Vector3d(0.0, 1.01 * kRadius, 0.0))) << t;
  }
  EXPECT_FALSE(space.OverPad(pad.At(1.0).p_WP - Eigen::Vector3d(1.01 * kRadius, 0.0, 0.0)));
  EXPECT_FALSE(space.OverPad(pad.At(5.0).p_WP + Eigen::Vector3d(1.01 * kRadius, 0.0, 0.0)));
}

TEST(PadStrip, ItsFloorIsBelowBothEndsThatAreOverThePad) {
  const ArcPad pad({0.0, 0.0, kDeck}, 0.5, 0.0, 0.0);
  const double end = kDeck + 1.0;
  const auto floor_from = [&](const Eigen::Vector3d& start) {
    FreeSpace space;
    LayPadStrip(pad, AtHeight(1.0), start, 0.0, 4.0, kRadius, &space);
    return space.pad_floor;
  };
  const double beside = floor_from({-5.0, 0.0, 0.6});
  EXPECT_LT(beside, end);
  EXPECT_GT(beside, end - 0.3);
  EXPECT_DOUBLE_EQ(floor_from({0.5, 0.1, 2.0}), beside);  // from higher up over the pad
  EXPECT_NEAR(floor_from({0.5, 0.1, 0.7}), beside - (end - 0.7), 1e-12);
}

}  // namespace
}  // namespace touchdown::planning
