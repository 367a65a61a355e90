// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/control/mission/landing_state_machine.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "control/test/mission_fixture.h"

namespace touchdown::control {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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

// Committed, a descent goes on without a sighting. So both the command and the vehicle have to be low, and the gate open.
// Both pad and plan are needed, for the whole time.
TEST(LandingStateMachine, HalfOfWhatItNeedsIsNoRecovery) {
  const Mission::Change lacks[] = {
      [](MissionInputs& in) { in.has_plan = false; },
      [](MissionInputs& in) { in.plan_failed_for = 0.5; },
      [](MissionInputs& in) { in.pad_converged = false; },
  };
  for (const Mission::Change& lack : lacks) {
    Mission mission;
    mission.GoTo(MissionMode::kTracking);
    mission.in.pad_available = false;
    ASSERT_EQ(mission.RunUntil(MissionMode::kHold), TransitionReason::kPadLost);
    mission.in.pad_available = true;
    lack(mission.in);
    mission.Run(3.0);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
    // The missing condition holds for a little less than required, then ends again.
    const MissionInputs lacking = mission.in;
    mission.in = Fine();
    mission.in.t = lacking.t;
    mission.Run(mission.parameters.hold_time - 0.1);
    lack(mission.in);
    mission.Run(0.5);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
    mission.in = Fine();
    mission.in.t = mission.state.t;
    EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kRecovered);
  }
}

TEST(LandingStateMachine, CommitsWhereCommandAndVehicleAreLowAndTheGateIsOpen) {
  const MissionParameters parameters;
  const auto committed = [&](double vehicle, bool sees) {
    Mission mission;
    mission.DescendTo(0.4);
    mission.height_follows = false;
    for (int k = 0; k < 200; ++k) {
      mission.in.height = std::max(vehicle, mission.outputs.foot_height);
      if (!sees) mission.in.tag_age = 10.0;
      mission.Tick([](MissionInputs&) {});
    }
    return mission.state.committed;
  };
  EXPECT_TRUE(committed(0.0, true));
  EXPECT_FALSE(committed(parameters.commit_height + 0.05, true)) << "the vehicle lags above it";
  EXPECT_FALSE(committed(0.0, false)) << "the gate is closed";
}

TEST(LandingStateMachine, TheCommandWaitsForAVehicleThatLags) {
  Mission mission;
  mission.DescendTo(0.8);
  mission.height_follows = false;
  mission.in.height = mission.outputs.foot_height + 0.5;  // it had to stop
  mission.Run(1.0);
  const double held = mission.outputs.foot_height;
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kLag);
  mission.Run(1.0);
  EXPECT_NEAR(mission.outputs.foot_height, held, 1e-6);
  // The goal counts as reached so near that the vehicle would stop there: the command goes on.
  mission.in.at_goal = true;
  mission.Run(0.2);
  EXPECT_LT(mission.outputs.foot_height, held);
  mission.in.at_goal = false;
  mission.Run(1.0);
  const double again = mission.outputs.foot_height;
  mission.in.height = again + 0.1;
  mission.Run(0.2);
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kNone);
  EXPECT_LT(mission.outputs.foot_height, again);
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
  EXPECT_TRUE(committed.outputs.committed);
  committed.in.horizontal_distance = 0.6;
  EXPECT_EQ(committed.RunUntil(MissionMode::kGoAround), TransitionReason::kErrorTooLarge);
  EXPECT_FALSE(committed.outputs.committed) << "a climb is not committed, low as it is";
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

/// Something keeps it down.
void GoAroundBelow(Mission& mission) {
  mission.DescendTo(0.8);
  mission.in.horizontal_distance = 1.1;
  ASSERT_EQ(mission.RunUntil(MissionMode::kGoAround), TransitionReason::kErrorTooLarge);
  mission.height_follows = false;
  mission.in.height = 0.5;
}

TEST(LandingStateMachine, ClimbEndsByTimeout) {
  Mission mission;
  GoAroundBelow(mission);
  EXPECT_EQ(mission.RunUntil(MissionMode::kTracking), TransitionReason::kClimbTimeout);
}

// It stood for 5 s where a roof or unseen cells were above, while the pad drove away.
TEST(LandingStateMachine, AClimbThatComesToRestIsOver) {
  Mission mission;
  GoAroundBelow(mission);
  mission.Run(1.0);
  ASSERT_EQ(mission.outputs.mode, MissionMode::kGoAround);
  mission.in.rests = true;
  mission.Run(0.1);
  EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
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
  gap.Tick();
  gap.in.t += 0.3;
  gap.Tick();
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

class EachDescent : public testing::TestWithParam<DescentStyle> {};

INSTANTIATE_TEST_SUITE_P(LandingStateMachine, EachDescent,
                         testing::Values(DescentStyle::kVertical, DescentStyle::kPlanned),
                         [](const auto& test) {
                           return test.param == DescentStyle::kPlanned ? "planned" : "vertical";
                         });

// Lands a mission of either style until a touch of the feet would end it.
void Land(DescentStyle style, Mission* mission) {
  mission->in.descent = style;
  mission->GoTo(MissionMode::kTracking);
  mission->in.horizontal_distance = 0.1;
  mission->in.arrival_in = 0.6;
  ASSERT_NE(mission->RunUntil(MissionMode::kLanding), TransitionReason::kNone);
}

TEST_P(EachDescent, WhatTheFeetTouchFarFromThePadIsNotTheDeck) {
  for (const double distance : {1.5, 3.0, 50.0}) {
    Mission mission;
    Land(GetParam(), &mission);
    mission.height_follows = false;
    mission.Run(5.0, [&](MissionInputs& in) {
      in.height = 0.0;
      in.foot_force = 5.0;
      in.horizontal_distance = distance;
    });
    EXPECT_NE(mission.outputs.mode, MissionMode::kDisarmed) << distance;
    EXPECT_NE(mission.outputs.mode, MissionMode::kLanding) << distance;
  }
}

TEST_P(EachDescent, NumbersThatComeBackAreFlownByAgain) {
  const auto cases = {&MissionInputs::height,           &MissionInputs::horizontal_distance,
                      &MissionInputs::horizontal_speed, &MissionInputs::sink_rate,
                      &MissionInputs::arrival_in,       &MissionInputs::foot_force};
  for (double MissionInputs::*number : cases) {
    Mission mission;
    Land(GetParam(), &mission);
    const double good = mission.in.*number;
    mission.height_follows = false;
    mission.Run(0.3, [&](MissionInputs& in) { in.*number = kNan; });
    EXPECT_EQ(mission.outputs.mode, MissionMode::kHold);
    EXPECT_TRUE(std::isfinite(mission.outputs.foot_height));
    mission.in.*number = good;
    mission.in.horizontal_distance = 5.0;
    mission.Run(3.0);
    EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking);
    EXPECT_NEAR(mission.outputs.foot_height, mission.parameters.follow_height, 1e-9);
  }
}

// Any inputs whatsoever: disarmed only after lasting force at the deck, in landing.
TEST_P(EachDescent, FuzzNeverDisarmsInTheAir) {
  const MissionParameters parameters;
  // A plan leads down by itself, and does not wait for tags.
  const bool planned = GetParam() == DescentStyle::kPlanned;
  const double stays = planned ? 0.8 : 1.0, oldest = planned ? 0.302 : 0.4;
  int disarmed = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    MissionState state;
    MissionInputs in = Fine();
    in.descent = GetParam();
    double touching_for = 0.0, lifted_for = -1.0, contact_for = 0.0;
    double passed = 0.0;   // since the last sample that has a time
    bool touched = false;  // at that
    for (int k = 0; k < 4000; ++k) {
      const double dt = uniform(random) < 0.02 ? 0.2 * uniform(random) : 0.01;
      if (uniform(random) < 0.05) in.pad_available = uniform(random) < 0.9;
      if (uniform(random) < 0.05) in.pad_converged = uniform(random) < 0.9;
      if (uniform(random) < 0.05) in.horizontal_distance = 0.35 * uniform(random);
      if (uniform(random) < 0.005) in.horizontal_distance = 3.0 * uniform(random);
      if (uniform(random) < 0.05) in.horizontal_speed = 0.5 * uniform(random);
      if (uniform(random) < 0.2) {
        in.height = stays * state.foot_height + 0.1 * (uniform(random) - 0.5);
      }
      if (uniform(random) < 0.05) in.tag_age = oldest * uniform(random);
      if (uniform(random) < 0.05) in.foot_force = 6.0 * uniform(random) - 1.0;
      if (uniform(random) < 0.02) in.plan_failed_for = uniform(random) < 0.95 ? 0.0 : 2.0;
      in.arrival_in -= dt;
      if (uniform(random) < 0.01) in.arrival_in = 2.0 * uniform(random);
      if (uniform(random) < 0.05) in.sink_rate = uniform(random);
      in.emergency = uniform(random) < 0.0005;
      MissionInputs fed = in;
      fed.t = in.t += dt;
      if (uniform(random) < 0.002) fed.height = kNan;
      if (uniform(random) < 0.002) fed.foot_force = kNan;
      if (uniform(random) < 0.002) fed.t = kNan;

      const bool touching = fed.foot_force >= parameters.contact_force &&
                            std::abs(fed.height) <= parameters.contact_height &&
                            fed.horizontal_distance <= parameters.contact_distance;
      const MissionMode before = state.mode;
      const MissionStep step = Step(state, fed, parameters);
      passed += dt;
      if (std::isfinite(fed.t)) {
        touching_for = touching && touched ? touching_for + passed : 0.0;
        // Nothing is known of the time between two samples.
        lifted_for =
            touching ? -1.0 : std::max(0.0, lifted_for + (lifted_for < 0.0 ? 0.0 : passed));
        // Two touches far apart are no lasting contact.
        const bool lasts = lifted_for <= parameters.contact_break + 1e-9 &&
                           passed <= parameters.contact_gap && (touched || contact_for > 0.0);
        contact_for = lasts ? contact_for + passed : 0.0;
        touched = touching;
        passed = 0.0;
      }
      state = step.state;
      ASSERT_TRUE(std::isfinite(state.foot_height) && std::isfinite(state.foot_height_rate));
      ASSERT_EQ(step.outputs.motors_armed, state.mode != MissionMode::kDisarmed);
      if (state.mode == MissionMode::kDisarmed) {
        ++disarmed;
        ASSERT_EQ(before, MissionMode::kLanding);
        ASSERT_EQ(step.outputs.reason, TransitionReason::kContact);
        ASSERT_TRUE(touching);
        ASSERT_GE(touching_for, parameters.contact_rest - 1e-9);
        ASSERT_GE(contact_for, parameters.contact_time - 1e-9);
        break;
      }
      ASSERT_EQ(step.outputs.reason == TransitionReason::kNone, before == state.mode);
    }
  }
  EXPECT_GT(disarmed, 30);
}

TEST(LandingStateMachine, TheCommandMeetsTheDeckWithTheContactRate) {
  Mission mission;
  mission.DescendTo(0.3);
  EXPECT_NEAR(mission.outputs.foot_height_rate, -mission.parameters.slow_rate, 1e-9);
  mission.DescendTo(0.0);
  EXPECT_NEAR(mission.outputs.foot_height_rate, -mission.parameters.contact_rate, 2e-3);
}

// Feet that bounce count as contact, but the rotors stop only when the feet rest.
TEST(LandingStateMachine, ABounceDoesNotInterruptContactAndIsNoRest) {
  const auto disarms_after = [](double lifted) {
    Mission mission;
    mission.DescendTo(0.05);
    const double begin = mission.in.t;
    const auto bouncing = [&](MissionInputs& in) {
      const double since = in.t - begin;
      in.height = 0.0;
      in.foot_force = since > 0.2 && since < 0.2 + lifted ? 0.0 : 10.0;
    };
    for (int k = 0; k < 300 && mission.outputs.mode == MissionMode::kLanding; ++k) {
      mission.Tick(bouncing);
    }
    EXPECT_EQ(mission.outputs.mode, MissionMode::kDisarmed);
    return mission.in.t - begin;
  };
  const MissionParameters p;
  EXPECT_NEAR(disarms_after(0.0), p.contact_time, 0.03);
  EXPECT_NEAR(disarms_after(0.08), 0.2 + 0.08 + p.contact_rest, 0.03);
  EXPECT_NEAR(disarms_after(0.3), 0.2 + 0.3 + p.contact_time, 0.03);
}

TEST(LandingStateMachine, WhoGoesToLookInterruptsTheDescent) {
  Mission mission;
  mission.DescendTo(0.8);
  mission.Run(2.0, [](MissionInputs& in) { in.looks = true; });
  EXPECT_EQ(mission.outputs.mode, MissionMode::kTracking) << "also near and slow over the pad";
  EXPECT_EQ(mission.outputs.descent_hold, DescentHold::kLook);
  mission.Tick([](MissionInputs& in) { in.looks = false; });
  EXPECT_EQ(mission.outputs.mode, MissionMode::kLanding);
  EXPECT_NE(mission.outputs.descent_hold, DescentHold::kLook);
}

TEST(LandingStateMachine, NamesAndParametersAreChecked) {
  EXPECT_EQ(ToString(MissionMode::kEmergencyStop), "emergency_stop");
  EXPECT_EQ(ToString(TransitionReason::kEmergencyCleared), "emergency_cleared");
  EXPECT_EQ(ToString(TransitionReason::kNoContact), "no_contact");
  EXPECT_EQ(ToString(DescentHold::kCorridor), "corridor");
  EXPECT_EQ(ToString(DescentHold::kAbove), "above");
  EXPECT_EQ(ToString(DescentHold::kLook), "look");
  EXPECT_EQ(ToString(TransitionReason::kLooks), "looks");
  EXPECT_EQ(ToString(Gate::kGust), "gust");
  EXPECT_EQ(ToString(Guidance::kIdle), "idle");
  MissionParameters parameters;
  EXPECT_NO_THROW(Validate(parameters));
  parameters.commit_height = 1.2;
  EXPECT_THROW(Validate(parameters), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::control
