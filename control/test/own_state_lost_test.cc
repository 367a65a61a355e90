// SPDX-License-Identifier: BSD-3-Clause
// The mission when the vehicle no longer knows its own state well.
#include <gtest/gtest.h>

#include "control/test/mission_fixture.h"

namespace touchdown::control {
namespace {

TEST(OwnStateLost, TrackingHoldsAndGoesOnOnceTheStateIsBack) {
  Mission mission;
  ASSERT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
  mission.in.own_fresh = mission.in.own_usable = false;
  mission.Run(mission.parameters.own_timeout);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
  EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kOwnStateLost);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kHoldPosition);
  mission.Run(5.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
  mission.in.own_usable = true;  // dead reckoning will do
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kRecovered);
}

TEST(OwnStateLost, HoveringStaysWithoutAnOwnState) {
  Mission mission;
  mission.in.own_fresh = mission.in.own_usable = false;
  mission.Run(5.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHovering);
}

TEST(OwnStateLost, DeadReckoningPausesAtTheGateAndIsNotCommitted) {
  Mission mission;
  mission.DescendTo(1.3);
  mission.in.own_fresh = false;
  mission.Run(1.5);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kGate);
  EXPECT_NEAR(mission.outputs.foot_height, mission.parameters.gate_height, 1e-9);
  mission.in.own_fresh = true;
  mission.DescendTo(0.3);
  EXPECT_TRUE(mission.outputs.committed);
  mission.in.own_fresh = false;  // the last stretch is bridged as it is without tags
  mission.Run(0.5);
  EXPECT_TRUE(mission.outputs.committed);
}

TEST(OwnStateLost, NoBridgeBeginsOnDeadReckoning) {
  for (const bool fresh : {true, false}) {
    Mission mission;
    mission.in.contact_sigma = 0.02;
    mission.DescendTo(0.5);
    mission.in.own_fresh = fresh;
    bool committed = false;
    for (int k = 0; k < 150; ++k) {  // the tags are lost
      mission.in.tag_age += kStep;
      mission.Tick();
      committed |= mission.outputs.committed;
    }
    EXPECT_EQ(committed, fresh);
  }
}

TEST(OwnStateLost, ACommittedLandingEndsWhereThePadMayBeTooFarOffUnlessItTouches) {
  for (const bool touching : {false, true}) {
    Mission mission;
    mission.DescendTo(0.02);
    ASSERT_TRUE(mission.outputs.committed);
    mission.in.foot_force = touching ? 2.0 * mission.parameters.contact_force : 0.0;
    mission.Tick();
    mission.in.tag_age = 0.8;
    mission.in.pad_sigma = mission.parameters.bridge_sigma + 0.01;
    mission.Tick();
    EXPECT_EQ(mission.outputs.mode, touching ? MissionMode::kLanding : MissionMode::kGoAround);
  }
}

TEST(OwnStateLost, AStateThatComesAndGoesDoesNotHideALostPad) {
  Mission mission;
  ASSERT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
  mission.in.pad_converged = false;
  for (int k = 0; k < 2000 && mission.outputs.mode == MissionMode::kTracking; ++k) {
    mission.in.own_usable = mission.in.own_fresh = k % 10 < 5;  // shorter than own_timeout
    mission.Tick();
  }
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
  EXPECT_EQ(mission.outputs.reason, TransitionReason::kPadLost);
}

TEST(OwnStateLost, DeadReckoningThatLastsIsNotWaitedOut) {
  Mission mission;
  mission.DescendTo(1.3);
  mission.in.own_fresh = false;
  mission.Run(mission.parameters.own_patience);
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kGate);
  mission.DescendTo(0.3);
  EXPECT_TRUE(mission.outputs.committed);
}

TEST(OwnStateLost, ALandingGoesAroundCommittedOrNotAndThenHolds) {
  for (const double height : {0.6, 0.3}) {
    Mission mission;
    mission.DescendTo(height);
    mission.in.own_fresh = mission.in.own_usable = false;
    EXPECT_EQ(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kOwnStateLost);
    EXPECT_EQ(mission.outputs.guidance, Guidance::kClimb);
    EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kOwnStateLost);
    EXPECT_GE(mission.outputs.foot_height,
              mission.parameters.follow_height - mission.parameters.climb_tolerance);
  }
}

TEST(OwnStateLost, AShortLossChangesNothing) {
  Mission mission;
  mission.DescendTo(1.3);
  mission.in.own_fresh = mission.in.own_usable = false;
  mission.Run(0.5 * mission.parameters.own_timeout);
  mission.in.own_fresh = mission.in.own_usable = true;
  mission.Run(0.1);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
  EXPECT_EQ(ToString(TransitionReason::kOwnStateLost), "own_state_lost");
}

}  // namespace
}  // namespace touchdown::control
