// SPDX-License-Identifier: BSD-3-Clause
// Every class of the rule, driven by made-up samples at 500 Hz.
#include "evaluation/judge/landing_judge.h"

#include <functional>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

constexpr double kDt = 0.002;
constexpr double kDeg = 3.14159265358979323846 / 180.0;

Eigen::Quaterniond Tilted(double angle_deg) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * kDeg, Eigen::Vector3d::UnitX()));
}

class LandingJudgeTest : public ::testing::Test {
 protected:
  LandingJudgeTest() : judge_(LandingRule{}, 20.0) {
    sample_.vehicle.p_WB = {1.05, 2.0, 0.7};
    sample_.pad.p_WP = {1.0, 2.0, 0.5};
    sample_.pad.v_WP = {0.8, 0.0, 0.0};
    sample_.vehicle.v_WB = {0.8, 0.0, -0.3};
  }

  /// Feeds the present sample for `seconds`, or until the outcome is decided.
  void Run(double seconds) {
    const double end = sample_.t + seconds;
    while (sample_.t < end && !judge_.outcome()) {
      judge_.Observe(sample_);
      sample_.t += kDt;
    }
  }

  void Touch() {
    Run(1.0);
    sample_.foot_on_pad = true;
    Run(kDt);
  }

  LandingJudge judge_;
  JudgeSample sample_;
};

TEST_F(LandingJudgeTest, RestUprightAndDisarmedIsALanding) {
  Touch();
  ASSERT_FALSE(judge_.outcome());
  sample_.vehicle.v_WB = sample_.pad.v_WP;
  Run(0.3);
  EXPECT_FALSE(judge_.outcome());
  sample_.armed = false;
  const double disarmed = sample_.t;
  Run(5.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kLanded);
  EXPECT_NEAR(sample_.t - disarmed, 1.0, 0.01);
  EXPECT_NEAR(judge_.touchdown()->t, 1.0, 0.01);
  EXPECT_NEAR(judge_.touchdown()->error_m, 0.05, 1e-12);
  EXPECT_NEAR(judge_.touchdown()->relative_velocity.z(), -0.3, 1e-12);
}

TEST_F(LandingJudgeTest, RestStartsAgainAfterALossOfContact) {
  Touch();
  sample_.armed = false;
  Run(0.8);
  sample_.foot_on_pad = false;
  Run(0.2);
  sample_.foot_on_pad = true;
  Run(0.8);
  EXPECT_FALSE(judge_.outcome());
  Run(0.3);
  EXPECT_EQ(judge_.outcome(), Outcome::kLanded);
}

TEST_F(LandingJudgeTest, AFlightThatStandsIsOverUnlessItTouchesThePad) {
  Run(1.0);
  sample_.stood = true;
  Run(kDt);
  EXPECT_EQ(judge_.outcome(), Outcome::kStood);
  judge_ = LandingJudge(LandingRule{}, 20.0);
  sample_.stood = false;
  Touch();
  sample_.stood = true;
  Run(0.1);
  EXPECT_FALSE(judge_.outcome());
}

TEST_F(LandingJudgeTest, AShortGapInContactDoesNotInterruptTheRest) {
  Touch();
  sample_.armed = false;
  Run(0.5);
  sample_.foot_on_pad = false;
  Run(0.06);
  sample_.foot_on_pad = true;
  Run(0.5);
  EXPECT_EQ(judge_.outcome(), Outcome::kLanded);
}

TEST_F(LandingJudgeTest, SpeedLimitsAreRelativeToTheDeckPointBelow) {
  // The deck turns: its point 0.5 m ahead of the centre moves sideways at 0.5 m/s.
  sample_.pad.yaw_rate = 1.0;
  sample_.vehicle.p_WB = {1.5, 2.0, 0.7};
  sample_.vehicle.v_WB = {0.8, 0.5 + 0.59, -0.49};
  Touch();
  EXPECT_FALSE(judge_.outcome());
  EXPECT_NEAR(judge_.touchdown()->relative_velocity.y(), 0.59, 1e-12);
  EXPECT_EQ(Broken({}, *judge_.touchdown()), "");
}

TEST_F(LandingJudgeTest, TooFastSidewaysIsHard) {
  sample_.vehicle.v_WB = {0.8 + 0.61, 0.0, -0.1};
  Touch();
  EXPECT_EQ(judge_.outcome(), Outcome::kHardTouchdown);
  ASSERT_TRUE(judge_.touchdown().has_value());
  EXPECT_EQ(Broken({}, *judge_.touchdown()), "0.610 m/s horizontally, 0.6 allowed");
}

TEST_F(LandingJudgeTest, TooFastDownIsHard) {
  sample_.vehicle.v_WB = {0.8, 0.0, -0.51};
  Touch();
  EXPECT_EQ(judge_.outcome(), Outcome::kHardTouchdown);
}

TEST_F(LandingJudgeTest, TiltIsMeasuredFromTheEquilibrium) {
  sample_.vehicle.q_WB = Tilted(30.0);
  sample_.equilibrium_axis = Tilted(20.0) * Eigen::Vector3d::UnitZ();
  Touch();
  EXPECT_FALSE(judge_.outcome());
  EXPECT_NEAR(judge_.touchdown()->tilt_over_equilibrium, 10.0 * kDeg, 1e-9);
  EXPECT_NEAR(judge_.touchdown()->tilt, 30.0 * kDeg, 1e-9);
}

TEST_F(LandingJudgeTest, AllThatIsBrokenIsNamed) {
  Touchdown touchdown;
  touchdown.relative_velocity = {0.3, 0.4, -0.75};
  touchdown.tilt_over_equilibrium = 15.5 * kDeg;
  EXPECT_EQ(
      Broken({}, touchdown),
      "0.750 m/s vertically, 0.5 allowed; 15.500 deg from the equilibrium's tilt, 15 allowed");
}

TEST_F(LandingJudgeTest, TooFarFromTheEquilibriumIsTilted) {
  sample_.vehicle.q_WB = Tilted(15.5);
  Touch();
  EXPECT_EQ(judge_.outcome(), Outcome::kTiltedTouchdown);
}

TEST_F(LandingJudgeTest, BeyondTheAbsoluteTiltIsTilted) {
  sample_.vehicle.q_WB = Tilted(41.0);
  sample_.equilibrium_axis = Tilted(41.0) * Eigen::Vector3d::UnitZ();
  Touch();
  EXPECT_EQ(judge_.outcome(), Outcome::kTiltedTouchdown);
}

TEST_F(LandingJudgeTest, AnyOtherTouchBeforeIsACollision) {
  Run(1.0);
  sample_.on_obstacle = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kCollision);
  EXPECT_FALSE(judge_.touchdown().has_value());
}

TEST_F(LandingJudgeTest, TheHullOnTheDeckInTheAirIsACollision) {
  Run(1.0);
  sample_.hull_on_deck = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kCollision);
}

TEST_F(LandingJudgeTest, AFootOnThePadDoesNotExcuseACollision) {
  Run(1.0);
  sample_.on_obstacle = true;
  sample_.foot_on_pad = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kCollision);
}

TEST_F(LandingJudgeTest, TheGroundNearThePadIsOffPad) {
  sample_.beside_pad = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kOffPad);
}

TEST_F(LandingJudgeTest, TheGroundFarFromThePadIsACollision) {
  sample_.vehicle.p_WB = {9.0, 2.0, 0.1};
  sample_.beside_pad = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kCollision);
}

TEST_F(LandingJudgeTest, StoppedRotorsInTheAirAreTheirOwnClass) {
  Run(1.0);
  sample_.armed = false;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kDisarmedInAir);
}

TEST_F(LandingJudgeTest, LeavingThePadIsABounce) {
  Touch();
  sample_.foot_on_pad = false;
  Run(2.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kBouncedOff);
}

TEST_F(LandingJudgeTest, FallingBesideThePadAfterContactIsABounce) {
  Touch();
  sample_.beside_pad = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kBouncedOff);
}

TEST_F(LandingJudgeTest, FallingOverIsATipOver) {
  Touch();
  sample_.vehicle.q_WB = Tilted(65.0);
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kTipOver);
}

TEST_F(LandingJudgeTest, TheHullOnTheDeckAfterContactIsATipOver) {
  Touch();
  sample_.hull_on_deck = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kTipOver);
}

TEST_F(LandingJudgeTest, AnObstacleTouchedWhileStandingOnThePadIsACollision) {
  Touch();
  sample_.armed = false;
  Run(0.9);
  EXPECT_FALSE(judge_.outcome());
  sample_.on_obstacle = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kCollision);
}

TEST_F(LandingJudgeTest, AnObstacleCountsBeforeTheFallThatItCauses) {
  Touch();
  sample_.vehicle.q_WB = Tilted(65.0);
  sample_.on_obstacle = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kCollision);
}

TEST_F(LandingJudgeTest, PhysicsThatFailedIsUnstable) {
  Run(1.0);
  sample_.simulated = false;
  sample_.on_obstacle = true;
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kUnstable);
}

TEST_F(LandingJudgeTest, TimeRunsOut) {
  Run(30.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kTimeout);
  EXPECT_NEAR(sample_.t, 20.0, 0.01);
}

TEST_F(LandingJudgeTest, TimeRunsOutWithoutThePad) {
  sample_.pad_known = false;
  sample_.plan_valid = false;
  Run(30.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kLostPad);
}

TEST_F(LandingJudgeTest, TimeRunsOutWithoutAPlan) {
  Run(10.0);
  sample_.plan_valid = false;
  Run(30.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kInfeasible);
}

TEST_F(LandingJudgeTest, FollowingUntilTheTimeIsUpIsWhatWasAskedFor) {
  judge_ = LandingJudge(LandingRule{}, 20.0, HoldTask{Outcome::kFollowed, 2.0, 0.0});
  Run(30.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kFollowed);
}

TEST_F(LandingJudgeTest, FollowingFromFarOffIsNone) {
  judge_ = LandingJudge(LandingRule{}, 20.0, HoldTask{Outcome::kFollowed, 2.0, 0.0});
  sample_.vehicle.p_WB.x() = 4.0;
  Run(30.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kTimeout);
}

TEST_F(LandingJudgeTest, FollowingWithoutAPlanIsInfeasible) {
  judge_ = LandingJudge(LandingRule{}, 20.0, HoldTask{Outcome::kFollowed, 2.0, 0.0});
  sample_.plan_valid = false;
  Run(30.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kInfeasible);
}

TEST_F(LandingJudgeTest, StayingArmedOnThePadIsNoLanding) {
  Touch();
  Run(30.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kTimeout);
}

TEST_F(LandingJudgeTest, NumbersThatAreNotFiniteAreUnstable) {
  Run(1.0);
  sample_.vehicle.p_WB.x() = std::numeric_limits<double>::quiet_NaN();
  Run(1.0);
  EXPECT_EQ(judge_.outcome(), Outcome::kUnstable);
}

TEST_F(LandingJudgeTest, TheFirstOutcomeStays) {
  sample_.on_obstacle = true;
  Run(1.0);
  sample_.on_obstacle = false;
  sample_.foot_on_pad = true;
  EXPECT_EQ(judge_.Observe(sample_), Outcome::kCollision);
}

// What --retry flies again: never an outcome that the judge gave.
TEST(Outcomes, OnlyWhatSaysNothingOfTheFlightIsLost) {
  for (int i = 0; i <= static_cast<int>(kLastOutcome); ++i) {
    const auto outcome = static_cast<Outcome>(i);
    EXPECT_EQ(IsLost(outcome), outcome > Outcome::kUnstable) << ToString(outcome);
  }
}

TEST(OutcomeText, EveryClassHasItsOwnNameAndSentence) {
  std::set<std::string> names;
  std::set<std::string> sentences;
  const int last = static_cast<int>(kLastOutcome);
  for (int i = 0; i <= last; ++i) {
    const auto outcome = static_cast<Outcome>(i);
    names.insert(ToString(outcome));
    sentences.insert(Explain(outcome));
    EXPECT_EQ(std::string(Explain(outcome)).back(), '.');
    EXPECT_EQ(OutcomeNamed(ToString(outcome)), outcome);
  }
  EXPECT_FALSE(OutcomeNamed("sunk"));
  EXPECT_EQ(static_cast<int>(names.size()), last + 1);
  EXPECT_EQ(static_cast<int>(sentences.size()), last + 1);
}

TEST_F(LandingJudgeTest, AStayIsDoneAfterItsTimeWithoutABreak) {
  for (const Outcome done : {Outcome::kFollowed, Outcome::kArrived}) {
    judge_ = LandingJudge(LandingRule{}, 20.0, HoldTask{done, 2.0, 3.0});
    sample_.t = 0.0;
    sample_.at_target = true;
    Run(2.9);
    EXPECT_FALSE(judge_.outcome());
    sample_.at_target = false;
    Run(kDt);
    sample_.at_target = true;
    const double again = sample_.t;
    Run(5.0);
    EXPECT_EQ(judge_.outcome(), done);
    EXPECT_NEAR(sample_.t - again, 3.0, 0.01);
  }
}

TEST_F(LandingJudgeTest, AStayThatIsNeverLongEnoughIsATimeout) {
  judge_ = LandingJudge(LandingRule{}, 20.0, HoldTask{Outcome::kFollowed, 2.0, 3.0});
  for (int i = 0; i < 20; ++i) {
    sample_.at_target = i % 2 == 0;
    Run(1.1);
  }
  EXPECT_EQ(judge_.outcome(), Outcome::kTimeout);
}

TEST_F(LandingJudgeTest, ThePadIsAnObstacleOnTheWayToAGoal) {
  judge_ = LandingJudge(LandingRule{}, 20.0, HoldTask{Outcome::kArrived, 0.5, 1.0});
  Touch();
  EXPECT_EQ(judge_.outcome(), Outcome::kCollision);
}

}  // namespace
}  // namespace touchdown::evaluation
