// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/control/landing_state_machine.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace touchdown::control {
namespace {

constexpr double kStep = 0.01;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Everything as it should be, well away from the pad.
MissionInputs Fine() {
  MissionInputs in;
  in.pad_available = true;
  in.pad_converged = true;
  in.horizontal_distance = 5.0;
  in.height = 1.5;
  in.pad_sigma = 0.02;
  in.tag_age = 0.05;
  in.has_plan = true;
  return in;
}

/// Runs the mission step by step; the vehicle's feet follow the command unless told otherwise.
class Mission {
 public:
  using Change = std::function<void(MissionInputs&)>;

  MissionState state;
  MissionOutputs outputs;
  MissionParameters parameters;
  MissionInputs in = Fine();
  bool height_follows = true;

  void Run(double duration, const Change& change = {}) {
    const int steps = static_cast<int>(std::lround(duration / kStep));
    for (int k = 0; k < steps; ++k) Tick(change);
  }

  /// Runs until the mode is reached; returns the reason, kNone after 20 s without.
  TransitionReason RunUntil(MissionMode mode) {
    for (int k = 0; k < 2000; ++k) {
      Tick({});
      if (outputs.mode == mode) return outputs.reason;
    }
    return TransitionReason::kNone;
  }

  void Tick(const Change& change) {
    in.t += kStep;
    if (height_follows && state.started) in.height = state.foot_height;
    if (change) change(in);
    const MissionStep step = Step(state, in, parameters);
    if (state.started) {  // the commanded height is continuous and its rate is its derivative
      const double dt = step.state.t - state.t;
      const double a = parameters.height_acceleration;
      const double advance = step.state.foot_height - state.foot_height;
      EXPECT_LE(
          std::abs(advance),
          std::max(std::abs(state.foot_height_rate), std::abs(step.state.foot_height_rate)) * dt +
              1e-12);
      if (step.state.mode != MissionMode::kDisarmed) {
        EXPECT_LE(std::abs(step.state.foot_height_rate - state.foot_height_rate), a * dt + 1e-12);
        EXPECT_NEAR(advance, 0.5 * (state.foot_height_rate + step.state.foot_height_rate) * dt,
                    1e-12);
      }
    }
    state = step.state;
    outputs = step.outputs;
  }

  void GoTo(MissionMode mode) {
    ASSERT_EQ(RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
    if (mode == MissionMode::kTracking) return;
    in.horizontal_distance = 0.1;
    ASSERT_EQ(RunUntil(MissionMode::kLanding), TransitionReason::kAbovePad);
  }

  /// Landing, commanded down to just below `height`.
  void DescendTo(double height) {
    GoTo(MissionMode::kLanding);
    for (int k = 0; k < 2000 && state.foot_height > height; ++k) Tick({});
    ASSERT_LE(state.foot_height, height);
  }
};

TEST(LandingStateMachine, LandsInOrder) {
  Mission mission;
  mission.GoTo(MissionMode::kLanding);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
  const double start = mission.in.t;
  for (int k = 0; k < 2000 && mission.outputs.motors_armed; ++k) {
    mission.Tick([](MissionInputs& in) {
      if (in.height <= 0.0) {  // the deck carries the feet
        in.height = 0.0;
        in.foot_force = 5.0;
      }
    });
  }
  EXPECT_EQ(mission.outputs.mode, MissionMode::kDisarmed);
  EXPECT_EQ(mission.outputs.reason, TransitionReason::kContact);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kIdle);
  EXPECT_LT(mission.in.t - start, 7.0);
  mission.in.emergency = true;  // final
  mission.Run(1.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kDisarmed);
}

TEST(LandingStateMachine, WaitsForTheHeadingButNotForever) {
  Mission mission;
  mission.in.yaw_aligned = false;
  mission.Run(1.9);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHovering);
  EXPECT_FALSE(mission.outputs.plan_requested);
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kAlignTimeout);
}

TEST(LandingStateMachine, HoversWithoutAPad) {
  Mission mission;
  mission.in.pad_converged = false;
  mission.Run(5.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHovering);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kHoldPosition);
}

TEST(LandingStateMachine, TracksUntilNearAndSlow) {
  Mission mission;
  mission.GoTo(MissionMode::kTracking);
  mission.in.horizontal_distance = 0.51;
  mission.Run(1.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
  mission.in.horizontal_distance = 0.3;
  mission.in.horizontal_speed = 1.0;
  mission.Run(1.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
  mission.in.horizontal_speed = 0.1;
  mission.in.descent = DescentStyle::kNone;
  mission.Run(1.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
  mission.in.descent = DescentStyle::kVertical;
  EXPECT_EQ(mission.RunUntil(MissionMode::kLanding), TransitionReason::kAbovePad);
}

TEST(LandingStateMachine, TrackingHoldsAndRecovers) {
  Mission mission;
  mission.GoTo(MissionMode::kTracking);
  mission.in.pad_available = false;
  EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kPadLost);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kHoldPosition);
  EXPECT_TRUE(mission.outputs.plan_requested);
  mission.in.pad_available = true;
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kRecovered);
  mission.in.plan_failed_for = 1.5;
  EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kPlanFailed);
  mission.Run(3.0);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
  mission.in.plan_failed_for = 0.0;
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kRecovered);
}

TEST(LandingStateMachine, GateHoldsAboveOneMetre) {
  for (int cause = 0; cause < 2; ++cause) {
    Mission mission;
    mission.GoTo(MissionMode::kLanding);
    (cause == 0 ? mission.in.pad_sigma : mission.in.tag_age) = 0.5;
    mission.Run(2.5);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
    EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kGate);
    EXPECT_NEAR(mission.outputs.foot_height, mission.parameters.gate_height, 1e-3);
    EXPECT_GE(mission.outputs.foot_height, mission.parameters.gate_height - 1e-9);
    mission.in.pad_sigma = 0.05;
    mission.in.tag_age = 0.1;
    mission.Run(1.0);
    EXPECT_LT(mission.outputs.foot_height, 0.9);
  }
}

TEST(LandingStateMachine, GateClosingBelowHoldsTheHeightThenGoesAround) {
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

TEST(LandingStateMachine, CommittedDescentNeedsNoTags) {
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

/// The tags are out of view from `height` down: their age grows, and the pad's 1 sigma with it.
Mission::Change Blind(const Mission& mission, double growth = 0.05) {
  return [&mission, growth, since = mission.in.t](MissionInputs& in) {
    in.tag_age = in.t - since;
    in.pad_sigma = 0.02 + growth * in.tag_age;
    in.contact_sigma =
        in.pad_sigma + growth * TimeToContact(mission.state, in.height, mission.parameters);
  };
}

TEST(LandingStateMachine, TagsLostNearTheDeckAreBridged) {
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

TEST(LandingStateMachine, WhatCannotBeBridgedIsNotDescended) {
  // Too long a way, and too vague a pad by its end.
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
    // Of what can still be seen for gate_tag_age, and braking; no farther.
    EXPECT_GT(lowest, lost - 0.2) << vague;
    EXPECT_FALSE(mission.outputs.committed);
  }
}

TEST(LandingStateMachine, ABridgeThatPausesIsGivenUp) {
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

TEST(LandingStateMachine, CommittedBlindDescentEndsWithTheBridge) {
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

TEST(LandingStateMachine, TimeToContactIsThatOfTheDescent) {
  Mission mission;
  mission.DescendTo(0.7);
  mission.in.horizontal_distance = 0.6;  // paused: it has to gain speed again
  mission.Run(1.0);
  mission.in.horizontal_distance = 0.1;
  const double foretold = TimeToContact(mission.state, mission.in.height, mission.parameters);
  const double begin = mission.in.t;
  for (int k = 0; k < 600 && mission.outputs.foot_height > 0.0; ++k) mission.Tick({});
  EXPECT_NEAR(mission.in.t - begin, foretold - mission.parameters.contact_reserve, 0.02);
  EXPECT_EQ(TimeToContact(mission.state, kNan, mission.parameters),
            std::numeric_limits<double>::infinity());
}

TEST(LandingStateMachine, VehicleThatLagsBehindIsNotCommitted) {
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

TEST(LandingStateMachine, CorridorHoldsTheHeight) {
  Mission mission;
  mission.DescendTo(0.8);
  mission.in.horizontal_distance = 0.6;
  mission.Run(1.0);
  const double held = mission.outputs.foot_height;
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kCorridor);
  mission.Run(1.0);
  EXPECT_NEAR(mission.outputs.foot_height, held, 1e-6);
  mission.in.horizontal_distance = 0.05;
  mission.Run(0.5);
  EXPECT_LT(mission.outputs.foot_height, held - 0.05);
}

TEST(LandingStateMachine, LargeErrorGoesAround) {
  Mission mission;
  mission.DescendTo(0.8);
  mission.in.horizontal_distance = 1.1;
  EXPECT_EQ(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kErrorTooLarge);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
  Mission committed;
  committed.DescendTo(0.2);
  committed.in.horizontal_distance = 0.6;
  EXPECT_EQ(committed.RunUntil(MissionMode::kGoAround), TransitionReason::kErrorTooLarge);
}

TEST(LandingStateMachine, LandingGivesUpWithoutPadOrPlan) {
  Mission mission;
  mission.DescendTo(1.2);
  mission.in.pad_available = false;
  EXPECT_EQ(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kPadLost);
  Mission other;
  other.DescendTo(0.8);
  other.in.plan_failed_for = 1.2;
  EXPECT_EQ(other.RunUntil(MissionMode::kGoAround), TransitionReason::kPlanFailed);
  EXPECT_EQ(other.outputs.guidance, Guidance::kClimb);
}

TEST(LandingStateMachine, ClimbEndsByTimeout) {
  Mission mission;
  mission.DescendTo(0.8);
  mission.in.horizontal_distance = 1.1;
  ASSERT_EQ(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kErrorTooLarge);
  mission.height_follows = false;
  mission.in.height = 0.5;  // something keeps it down
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kClimbTimeout);
}

TEST(LandingStateMachine, EmergencyStopsAndClears) {
  for (MissionMode mode : {MissionMode::kTracking, MissionMode::kLanding}) {
    Mission mission;
    mission.GoTo(mode);
    mission.in.emergency = true;
    EXPECT_EQ(mission.RunUntil(MissionMode::kEmergencyStop), TransitionReason::kEmergency);
    EXPECT_EQ(mission.outputs.guidance, Guidance::kHoldPosition);
    EXPECT_TRUE(mission.outputs.motors_armed);
    mission.Run(3.0);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kEmergencyStop);
    mission.in.emergency = false;
    EXPECT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kEmergencyCleared);
    EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kRecovered);
  }
}

TEST(LandingStateMachine, TouchesDoNotDisarm) {
  Mission mission;
  mission.DescendTo(0.1);
  // Bounces: 50 ms of force, 20 ms without.
  int k = 0;
  mission.Run(1.0, [&k](MissionInputs& in) {
    in.height = 0.02;
    in.foot_force = k++ % 7 < 5 ? 8.0 : 0.0;
  });
  EXPECT_TRUE(mission.outputs.motors_armed);
  // Force far above the deck is not the deck.
  Mission high;
  high.DescendTo(0.8);
  high.in.foot_force = 10.0;
  high.Run(0.5);
  EXPECT_TRUE(high.outputs.motors_armed);
  // Two samples with a gap between them are not lasting contact.
  Mission gap;
  gap.DescendTo(0.1);
  gap.in.foot_force = 10.0;
  gap.Tick({});
  gap.in.t += 0.3;
  gap.Tick({});
  EXPECT_TRUE(gap.outputs.motors_armed);
}

TEST(LandingStateMachine, BrokenNumbersHold) {
  const std::vector<std::function<void(MissionInputs&)>> breakages = {
      [](MissionInputs& in) { in.horizontal_distance = kNan; },
      [](MissionInputs& in) { in.height = kNan; },
      [](MissionInputs& in) { in.horizontal_speed = kNan; },
      [](MissionInputs& in) { in.pad_sigma = kNan; },
      [](MissionInputs& in) { in.contact_sigma = kNan; },
      [](MissionInputs& in) { in.tag_age = kNan; },
      [](MissionInputs& in) { in.foot_force = kNan; },
      [](MissionInputs& in) { in.plan_failed_for = kNan; },
      [](MissionInputs& in) { in.height = std::numeric_limits<double>::infinity(); }};
  for (const auto& breakage : breakages) {
    Mission mission;
    mission.DescendTo(0.2);
    mission.Run(0.15, breakage);  // a short one is bridged
    EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
    mission.Run(0.3, breakage);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
    EXPECT_TRUE(mission.outputs.motors_armed);
    EXPECT_TRUE(std::isfinite(mission.outputs.foot_height));
  }
}

TEST(LandingStateMachine, BrokenTimeHoldsWithoutLosingTheState) {
  Mission mission;
  mission.GoTo(MissionMode::kTracking);
  MissionInputs in = mission.in;
  in.t = kNan;
  const MissionStep step = Step(mission.state, in, mission.parameters);
  EXPECT_EQ(step.outputs.guidance, Guidance::kHoldPosition);
  EXPECT_EQ(step.state.t, mission.state.t);
  in.t = mission.state.t - 5.0;  // backwards: as if no time had passed
  EXPECT_EQ(Step(mission.state, in, mission.parameters).state.t, mission.state.t);
}

// Any inputs whatsoever: disarmed only after lasting force near the deck, in landing.
TEST(LandingStateMachine, FuzzNeverDisarmsInTheAir) {
  const MissionParameters parameters;
  int disarmed = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    MissionState state;
    MissionInputs in = Fine();
    double touching_for = 0.0;
    for (int k = 0; k < 4000; ++k) {
      const double dt = uniform(random) < 0.02 ? 0.2 * uniform(random) : 0.01;
      if (uniform(random) < 0.05) in.pad_available = uniform(random) < 0.9;
      if (uniform(random) < 0.05) in.pad_converged = uniform(random) < 0.9;
      if (uniform(random) < 0.05) in.horizontal_distance = 0.35 * uniform(random);
      if (uniform(random) < 0.05) in.horizontal_speed = 0.5 * uniform(random);
      if (uniform(random) < 0.2) in.height = state.foot_height + 0.1 * (uniform(random) - 0.5);
      if (uniform(random) < 0.05) in.tag_age = 0.4 * uniform(random);
      if (uniform(random) < 0.05) in.foot_force = 6.0 * uniform(random) - 1.0;
      if (uniform(random) < 0.02) in.plan_failed_for = uniform(random) < 0.95 ? 0.0 : 2.0;
      in.emergency = uniform(random) < 0.0005;
      MissionInputs fed = in;
      fed.t = in.t += dt;
      if (uniform(random) < 0.002) fed.height = kNan;
      if (uniform(random) < 0.002) fed.foot_force = kNan;
      if (uniform(random) < 0.002) fed.t = kNan;

      const bool touching = fed.foot_force >= parameters.contact_force &&
                            std::abs(fed.height) <= parameters.contact_height;
      const MissionMode before = state.mode;
      const MissionStep step = Step(state, fed, parameters);
      if (std::isfinite(fed.t)) touching_for = touching ? touching_for + dt : 0.0;
      state = step.state;
      ASSERT_TRUE(std::isfinite(state.foot_height) && std::isfinite(state.foot_height_rate));
      ASSERT_EQ(step.outputs.motors_armed, state.mode != MissionMode::kDisarmed);
      if (state.mode == MissionMode::kDisarmed) {
        ++disarmed;
        ASSERT_EQ(before, MissionMode::kLanding);
        ASSERT_EQ(step.outputs.reason, TransitionReason::kContact);
        ASSERT_TRUE(touching);
        ASSERT_GE(touching_for, parameters.contact_time - 1e-9);
        break;
      }
      ASSERT_EQ(step.outputs.reason == TransitionReason::kNone, before == state.mode);
    }
  }
  EXPECT_GT(disarmed, 30);
}

TEST(LandingStateMachine, NamesAndParametersAreChecked) {
  EXPECT_EQ(ToString(MissionMode::kEmergencyStop), "emergency_stop");
  EXPECT_EQ(ToString(TransitionReason::kEmergencyCleared), "emergency_cleared");
  EXPECT_EQ(ToString(TransitionReason::kNoContact), "no_contact");
  EXPECT_EQ(ToString(DescentHold::kCorridor), "corridor");
  EXPECT_EQ(ToString(Guidance::kIdle), "idle");
  MissionParameters parameters;
  EXPECT_NO_THROW(Validate(parameters));
  parameters.commit_height = 1.2;
  EXPECT_THROW(Validate(parameters), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::control
