// SPDX-License-Identifier: BSD-3-Clause
// What the mission does when the vehicle no longer knows its own state well.
#include <gtest/gtest.h>

#include "touchdown/control/landing_state_machine.h"

namespace touchdown::control {
namespace {

constexpr double kStep = 0.01;

/// A mission over the pad with everything as it should be; the feet follow the command.
class OwnStateLost : public ::testing::Test {
 protected:
  OwnStateLost() {
    in_.pad_available = in_.pad_converged = in_.has_plan = true;
    in_.horizontal_distance = 0.1;
    in_.height = 1.5;
    in_.pad_sigma = 0.02;
    in_.tag_age = 0.05;
  }

  void Run(double duration) {
    for (double t = 0.0; t < duration - 0.5 * kStep; t += kStep) Tick();
  }

  /// Ticks until the mode is reached; the reason, kNone after 20 s without.
  TransitionReason RunUntil(MissionMode mode) {
    for (int k = 0; k < 2000; ++k) {
      Tick();
      if (out_.mode == mode) return out_.reason;
    }
    return TransitionReason::kNone;
  }

  void DescendTo(double height) {
    for (int k = 0; k < 2000 && !(out_.mode == MissionMode::kLanding && in_.height < height); ++k) {
      Tick();
    }
    ASSERT_EQ(out_.mode, MissionMode::kLanding);
  }

  void Tick() {
    in_.t += kStep;
    if (state_.started) in_.height = state_.foot_height;
    const MissionStep step = Step(state_, in_, parameters_);
    state_ = step.state;
    out_ = step.outputs;
  }

  MissionInputs in_;
  MissionParameters parameters_;
  MissionState state_;
  MissionOutputs out_;
};

TEST_F(OwnStateLost, TrackingHoldsAndGoesOnOnceTheStateIsBack) {
  in_.horizontal_distance = 5.0;
  ASSERT_EQ(RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
  in_.own_fresh = in_.own_usable = false;
  Run(parameters_.own_timeout);
  EXPECT_EQ(out_.mode, MissionMode::kTracking);
  EXPECT_EQ(RunUntil(MissionMode::kHold), TransitionReason::kOwnStateLost);
  EXPECT_EQ(out_.guidance, Guidance::kHoldPosition);
  Run(5.0);
  EXPECT_EQ(out_.mode, MissionMode::kHold);
  in_.own_usable = true;  // dead reckoning will do
  EXPECT_EQ(RunUntil(MissionMode::kTracking), TransitionReason::kRecovered);
}

TEST_F(OwnStateLost, HoveringStaysWithoutAnOwnState) {
  in_.own_fresh = in_.own_usable = false;
  Run(5.0);
  EXPECT_EQ(out_.mode, MissionMode::kHovering);
}

TEST_F(OwnStateLost, DeadReckoningPausesAtTheGateAndIsNotCommitted) {
  DescendTo(1.3);
  in_.own_fresh = false;
  Run(1.5);
  EXPECT_EQ(out_.mode, MissionMode::kLanding);
  EXPECT_EQ(out_.descent_hold, DescentHold::kGate);
  EXPECT_NEAR(out_.foot_height, parameters_.gate_height, 1e-9);
  in_.own_fresh = true;
  DescendTo(0.3);
  EXPECT_TRUE(out_.committed);
  in_.own_fresh = false;  // the last stretch is bridged as it is without tags
  Run(0.5);
  EXPECT_TRUE(out_.committed);
}

TEST_F(OwnStateLost, NoBridgeBeginsOnDeadReckoning) {
  for (const bool fresh : {true, false}) {
    state_ = {};
    in_ = {};
    in_.pad_available = in_.pad_converged = in_.has_plan = true;
    in_.horizontal_distance = 0.1;
    in_.height = 1.5;
    in_.pad_sigma = in_.contact_sigma = 0.02;
    in_.tag_age = 0.05;
    DescendTo(0.6);
    in_.own_fresh = fresh;
    bool committed = false;
    for (int k = 0; k < 150; ++k) {  // the tags are lost
      in_.tag_age += kStep;
      Tick();
      committed |= out_.committed;
    }
    EXPECT_EQ(committed, fresh);
  }
}

TEST_F(OwnStateLost, ACommittedLandingEndsWhereThePadMayBeTooFarOffUnlessItTouches) {
  for (const bool touching : {false, true}) {
    state_ = {};
    in_ = {};
    in_.pad_available = in_.pad_converged = in_.has_plan = true;
    in_.horizontal_distance = 0.1;
    in_.height = 1.5;
    in_.pad_sigma = 0.02;
    in_.tag_age = 0.05;
    DescendTo(0.02);
    ASSERT_TRUE(out_.committed);
    in_.foot_force = touching ? 2.0 * parameters_.contact_force : 0.0;
    Tick();
    in_.tag_age = 0.8;
    in_.pad_sigma = parameters_.bridge_sigma + 0.01;
    Tick();
    EXPECT_EQ(out_.mode, touching ? MissionMode::kLanding : MissionMode::kGoAround);
  }
}

TEST_F(OwnStateLost, AStateThatComesAndGoesDoesNotHideALostPad) {
  in_.horizontal_distance = 5.0;
  ASSERT_EQ(RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
  in_.pad_converged = false;
  for (int k = 0; k < 2000 && out_.mode == MissionMode::kTracking; ++k) {
    in_.own_usable = in_.own_fresh = k % 10 < 5;  // shorter than own_timeout
    Tick();
  }
  EXPECT_EQ(out_.mode, MissionMode::kHold);
  EXPECT_EQ(out_.reason, TransitionReason::kPadLost);
}

TEST_F(OwnStateLost, DeadReckoningThatLastsIsNotWaitedOut) {
  DescendTo(1.3);
  in_.own_fresh = false;
  Run(parameters_.own_patience);
  EXPECT_EQ(out_.descent_hold, DescentHold::kGate);
  DescendTo(0.3);
  EXPECT_TRUE(out_.committed);
}

TEST_F(OwnStateLost, ALandingGoesAroundCommittedOrNotAndThenHolds) {
  for (const double height : {0.6, 0.3}) {
    state_ = {};
    in_.own_fresh = in_.own_usable = true;
    DescendTo(height);
    in_.own_fresh = in_.own_usable = false;
    EXPECT_EQ(RunUntil(MissionMode::kGoAround), TransitionReason::kOwnStateLost);
    EXPECT_EQ(out_.guidance, Guidance::kClimb);
    EXPECT_EQ(RunUntil(MissionMode::kHold), TransitionReason::kOwnStateLost);
    EXPECT_GE(out_.foot_height, parameters_.follow_height - parameters_.climb_tolerance);
  }
}

TEST_F(OwnStateLost, AShortLossChangesNothing) {
  DescendTo(1.3);
  in_.own_fresh = in_.own_usable = false;
  Run(0.5 * parameters_.own_timeout);
  in_.own_fresh = in_.own_usable = true;
  Run(0.1);
  EXPECT_EQ(out_.mode, MissionMode::kLanding);
  EXPECT_EQ(ToString(TransitionReason::kOwnStateLost), "own_state_lost");
}

}  // namespace
}  // namespace touchdown::control
