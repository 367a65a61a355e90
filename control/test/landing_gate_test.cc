// SPDX-License-Identifier: BSD-3-Clause
// The gate of the descent, and the bridge over what is flown without tags in view.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "control/test/mission_fixture.h"

namespace touchdown::control {
namespace {

TEST(LandingGate, GateHoldsAboveOneMetre) {
  for (int cause = 0; cause < 2; ++cause) {
    Mission mission;
    mission.GoTo(MissionMode::kLanding);
    (cause == 0 ? mission.in.pad_sigma : mission.in.tag_age) = 0.5;
    mission.Run(2.5);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
    EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kGate);
    EXPECT_EQ(mission.outputs.gate, cause == 0 ? Gate::kPadUncertain : Gate::kTagsUnseen);
    EXPECT_NEAR(mission.outputs.foot_height, mission.parameters.gate_height, 1e-3);
    EXPECT_GE(mission.outputs.foot_height, mission.parameters.gate_height - 1e-9);
    mission.in.pad_sigma = 0.05;
    mission.in.tag_age = 0.1;
    mission.Run(1.0);
    EXPECT_LT(mission.outputs.foot_height, 0.9);
  }
}

// The tags are in view: no go-around to wait for a lull.
TEST(LandingGate, AGustIsWaitedOutAtTheHeightOfTheGateOrBelow) {
  for (const double begins : {1.4, 0.7, 0.37}) {
    Mission mission;
    mission.DescendTo(begins);
    mission.in.lean = mission.parameters.lean_max + 0.1;
    mission.Run(mission.parameters.gate_timeout + 2.0);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding) << begins;
    EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kGate) << begins;
    EXPECT_EQ(mission.outputs.gate, Gate::kGust) << begins;
    EXPECT_GT(mission.outputs.foot_height, std::min(begins, mission.parameters.gate_height) - 0.1);
    mission.in.lean = mission.parameters.lean_max - 0.1;
    mission.Run(1.0);
    EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kNone) << begins;
    EXPECT_EQ(mission.outputs.gate, Gate::kOpen) << begins;
  }
}

TEST(LandingGate, CommittedItIsGivenUpInAGust) {
  Mission mission;
  mission.DescendTo(0.2);
  ASSERT_TRUE(mission.outputs.committed);
  mission.in.lean = mission.parameters.lean_max + 0.1;
  mission.Tick();
  EXPECT_EQ(mission.outputs.mode, MissionMode::kGoAround);
  EXPECT_EQ(mission.outputs.reason, TransitionReason::kGust);
}

TEST(LandingGate, GateClosingBelowHoldsTheHeightThenGoesAround) {
  Mission mission;
  mission.DescendTo(0.7);
  mission.in.tag_age = std::numeric_limits<double>::infinity();
  mission.Run(1.0);
  const double held = mission.outputs.foot_height;
  EXPECT_GT(held, 0.6);
  mission.Run(1.0);
  EXPECT_NEAR(mission.outputs.foot_height, held, 1e-6);
  EXPECT_NEAR(mission.outputs.foot_height_rate, 0.0, 1e-6);
  EXPECT_EQ(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kTagsLost);
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kClimbComplete);
  EXPECT_NEAR(mission.outputs.foot_height, mission.parameters.follow_height, 0.3);
}

TEST(LandingGate, CommittedDescentNeedsNoTags) {
  Mission mission;
  mission.DescendTo(0.3);
  EXPECT_TRUE(mission.outputs.committed);
  mission.in.tag_age = 1.0;
  mission.in.pad_sigma = 0.15;
  mission.in.pad_converged = false;
  mission.Run(1.5);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
  EXPECT_LT(mission.outputs.foot_height, 0.0);
  // No deck there: the command stops at the press depth, then the mission gives up.
  EXPECT_EQ(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kNoContact);
  EXPECT_GE(mission.outputs.foot_height, -mission.parameters.press_depth - 1e-9);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kClimb);  // no pad to follow
  EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kPadLost);
}

TEST(LandingGate, VehicleThatLagsBehindIsNotCommitted) {
  Mission mission;
  mission.GoTo(MissionMode::kLanding);
  mission.height_follows = false;
  mission.in.height = 0.8;
  mission.Run(6.0);
  EXPECT_FALSE(mission.outputs.committed);
  mission.in.tag_age = 1.0;
  mission.Run(0.5);
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kGate);
}

/// The tags are out of view from `height` down: their age grows, and the pad's 1 sigma with it.
Mission::Change Blind(const Mission& mission, double growth = 0.05) {
  return [&mission, growth, since = mission.in.t](MissionInputs& in) {
    in.tag_age = in.t - since;
    in.pad_sigma = 0.02 + growth * in.tag_age;
    in.contact_sigma = in.pad_sigma + growth * ContactIn(mission.state, in, mission.parameters);
  };
}

TEST(LandingGate, TagsLostNearTheDeckAreBridged) {
  Mission mission;
  mission.DescendTo(0.55);
  const Mission::Change blind = Blind(mission);
  double last = mission.outputs.foot_height;
  for (int k = 0; k < 300 && mission.outputs.foot_height > 0.0; ++k) {
    mission.Tick(blind);
    EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kNone);
    EXPECT_LT(mission.outputs.foot_height, last);  // no pause on the way
    last = mission.outputs.foot_height;
  }
  EXPECT_LE(mission.outputs.foot_height, 0.0);
  EXPECT_TRUE(mission.outputs.committed);
  EXPECT_LE(mission.in.tag_age, mission.parameters.bridge_time);
}

TEST(LandingGate, WhatCannotBeBridgedIsNotDescended) {
  // The way is too long, and the pad too uncertain at its end.
  for (const bool vague : {false, true}) {
    Mission mission;
    mission.DescendTo(vague ? 0.55 : 0.8);
    const Mission::Change blind = Blind(mission, vague ? 0.2 : 0.01);
    const double lost = mission.outputs.foot_height;
    double lowest = lost;
    for (int k = 0; k < 600 && mission.outputs.mode == MissionMode::kLanding; ++k) {
      mission.Tick(blind);
      lowest = std::min(lowest, mission.outputs.foot_height);
    }
    EXPECT_EQ(mission.outputs.reason, TransitionReason::kTagsLost) << vague;
    // Only as far as gate_tag_age and braking allow.
    EXPECT_GT(lowest, lost - 0.2) << vague;
    EXPECT_FALSE(mission.outputs.committed);
  }
}

TEST(LandingGate, ABridgeThatPausesIsGivenUp) {
  Mission mission;
  mission.DescendTo(0.55);
  const Mission::Change blind = Blind(mission);
  mission.Run(0.5, blind);
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kNone);
  mission.in.horizontal_distance = 0.6;  // out of the corridor for a while
  mission.Run(1.2, blind);
  mission.in.horizontal_distance = 0.1;
  mission.Run(0.5, blind);
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kGate);  // the time has run out
  EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
  for (int k = 0; k < 400 && mission.outputs.mode == MissionMode::kLanding; ++k) {
    mission.Tick(blind);
  }
  EXPECT_EQ(mission.outputs.reason, TransitionReason::kTagsLost);
  mission.in.tag_age = 0.05;  // seen again on the way up
  mission.in.pad_sigma = mission.in.contact_sigma = 0.02;
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kClimbComplete);
}

TEST(LandingGate, CommittedBlindDescentEndsWithTheBridge) {
  for (const bool vague : {false, true}) {
    Mission mission;
    mission.DescendTo(0.2);
    ASSERT_TRUE(mission.outputs.committed);
    const double begin = mission.in.t;
    const Mission::Change blind = Blind(mission, vague ? 0.1 : 0.001);
    for (int k = 0; k < 600 && mission.outputs.mode == MissionMode::kLanding; ++k) {
      mission.Tick(blind);  // no deck comes
    }
    EXPECT_EQ(mission.outputs.mode, MissionMode::kGoAround) << vague;
    EXPECT_EQ(mission.outputs.reason, TransitionReason::kTagsLost) << vague;
    const MissionParameters& p = mission.parameters;
    const double expected = vague ? (p.bridge_sigma - 0.02) / 0.1 : p.bridge_time;
    EXPECT_NEAR(mission.in.t - begin, expected, 0.05) << vague;
  }
}

TEST(LandingGate, ContactInIsThatOfTheDescent) {
  Mission mission;
  mission.DescendTo(0.7);
  mission.in.horizontal_distance = 0.6;  // paused: it has to gain speed again
  mission.Run(1.0);
  mission.in.horizontal_distance = 0.1;
  const double predicted = ContactIn(mission.state, mission.in, mission.parameters);
  const double begin = mission.in.t;
  for (int k = 0; k < 600 && mission.outputs.foot_height > 0.0; ++k) mission.Tick();
  EXPECT_NEAR(mission.in.t - begin, predicted - mission.parameters.contact_reserve, 0.02);
  mission.in.height = std::nan("");
  EXPECT_EQ(ContactIn(mission.state, mission.in, mission.parameters),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace touchdown::control
