// SPDX-License-Identifier: BSD-3-Clause
#include "planning/certify/pad_strip.h"

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

constexpr double kRadius = 0.8, kDeck = 0.3, kContactHeight = 0.12;

EndpointTarget AtHeight(double height) {
  EndpointTarget target;
  target.height = target.height_floor = height;
  return target;
}

TEST(PadStrip, CoversThePadFromStartToArrival) {
  const ArcPad pad({1.0, 2.0, kDeck}, 0.5, 0.0, 0.0);
  FreeSpace space;
  LayPadStrip(pad, AtHeight(1.0), {-5.0, 0.0, 2.0}, 1.0, 5.0, kRadius, kContactHeight, &space);
  for (double t = 1.0; t <= 5.0; t += 0.25) {
    EXPECT_TRUE(space.OverPad(pad.At(t).p_WP)) << t;
    EXPECT_FALSE(space.OverPad(pad.At(t).p_WP + Eigen::Vector3d(0.0, 1.01 * kRadius, 0.0))) << t;
  }
  EXPECT_FALSE(space.OverPad(pad.At(1.0).p_WP - Eigen::Vector3d(1.01 * kRadius, 0.0, 0.0)));
  EXPECT_FALSE(space.OverPad(pad.At(5.0).p_WP + Eigen::Vector3d(1.01 * kRadius, 0.0, 0.0)));
}

double FloorOf(double target_height, const Eigen::Vector3d& start) {
  const ArcPad pad({0.0, 0.0, kDeck}, 0.5, 0.0, 0.0);
  FreeSpace space;
  LayPadStrip(pad, AtHeight(target_height), start, 0.0, 4.0, kRadius, kContactHeight, &space);
  return space.pad_floor;
}

TEST(PadStrip, ItsFloorIsTheDeckHoweverHighAPlanEnds) {
  const double on_deck = kDeck + kContactHeight;
  for (const double target_height : {1.0, 1.5, 3.0}) {
    for (const Eigen::Vector3d& start :
         {Eigen::Vector3d(-5.0, 0.0, 0.2), Eigen::Vector3d(0.5, 0.1, 2.0)}) {
      EXPECT_GT(FloorOf(target_height, start), on_deck);
      EXPECT_LT(FloorOf(target_height, start), on_deck + 0.2);
    }
  }
}

TEST(PadStrip, ItsFloorIsBelowBothEndsThatAreOverThePad) {
  const Eigen::Vector3d beside(-5.0, 0.0, 0.2), low(0.5, 0.1, kDeck + 0.14);
  for (const double contact : {kContactHeight, 0.0, -0.3}) {
    EXPECT_LT(FloorOf(contact, beside), kDeck + contact);
    EXPECT_GT(FloorOf(contact, beside), kDeck + contact - 0.3);
  }
  EXPECT_LT(FloorOf(1.0, low), low.z());
  EXPECT_GT(FloorOf(1.0, low), low.z() - 0.3);
}

}  // namespace
}  // namespace touchdown::planning
