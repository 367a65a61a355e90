// SPDX-License-Identifier: BSD-3-Clause
// The mission when no depth images come any more.
#include <cmath>

#include <gtest/gtest.h>

#include "control/test/mission_fixture.h"

namespace touchdown::control {
namespace {

void Age(MissionInputs& in) { in.depth_age += kStep; }

TEST(DepthLost, TrackingHoldsUntilImagesComeAgain) {
  Mission mission;
  ASSERT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
  mission.Run(mission.parameters.depth_timeout - kStep, Age);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
  mission.Run(3.0 * kStep, Age);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kHoldPosition);
  mission.Run(5.0, Age);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
  mission.in.depth_age = 0.1;
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kRecovered);
}

TEST(DepthLost, RareImagesInterruptNothing) {
  Mission mission;
  ASSERT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
  for (int k = 0; k < 5; ++k) {
    mission.Run(0.9 * mission.parameters.depth_timeout, Age);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
    mission.in.depth_age = 0.0;
  }
}

// Its way down was seen free: to give it up would be no safer.
TEST(DepthLost, ALandingGoesOn) {
  Mission mission;
  mission.DescendTo(0.5);
  mission.in.depth_age = 10.0;
  mission.DescendTo(0.3);
  EXPECT_TRUE(mission.outputs.committed);
}

TEST(DepthLost, AGoAroundEndsInAHold) {
  Mission mission;
  mission.DescendTo(0.8);
  mission.in.depth_age = 10.0;
  mission.in.horizontal_distance = 2.0;  // blown off
  ASSERT_NE(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kNone);
  EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kDepthLost);
}

TEST(DepthLost, AnAgeThatIsNoNumberIsInvalid) {
  Mission mission;
  ASSERT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
  mission.in.depth_age = std::nan("");
  EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kInvalidInput);
}

TEST(DepthLost, ItHasAName) { EXPECT_EQ(ToString(TransitionReason::kDepthLost), "depth_lost"); }

}  // namespace
}  // namespace touchdown::control
