// SPDX-License-Identifier: BSD-3-Clause
// A landing by one plan to contact: when it is decided, when it is given up, and what leads it.
#include <ostream>

#include "control/test/mission_fixture.h"

namespace touchdown::control {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// A mission in tracking with a plan that touches the deck in `arrival` seconds. Distance and height
// shrink with the remaining time, as they do on a plan.
class Approach : public Mission {
 public:
  explicit Approach(double arrival = 4.0) {
    in.descent = DescentStyle::kPlanned;
    in.arrival_in = kNever;
    height_follows = false;
    Run(0.5);
    contact_t = in.t + arrival;
  }

  /// Until `arrival` before contact.
  void FlyTo(double arrival, const Change& change = {}) {
    const auto along = [&](MissionInputs& inputs) {
      inputs.arrival_in = contact_t - inputs.t;
      inputs.height = std::max(0.0, 0.8 * inputs.arrival_in);
      inputs.horizontal_distance = std::max(0.0, 0.9 * inputs.arrival_in);
      if (change) change(inputs);
    };
    while (in.t + kStep <= contact_t - arrival) Tick(along);
  }

  double contact_t = 0.0;
};

MissionMode ModeOf(const Mission& mission) { return mission.outputs.mode; }

TEST(PlannedDescent, TrackingLeadsToContactFromTheStart) {
  Approach mission;
  mission.FlyTo(2.0);
  EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kTouchDown);
  EXPECT_TRUE(mission.outputs.plan_requested);
  EXPECT_TRUE(mission.outputs.motors_armed);
}

// A go-around for which nothing else is certified ends on the deck: the rotors stop there as after any landing.
TEST(PlannedDescent, WhatIsFlownToContactEndsByContactInAnyMode) {
  for (const bool lands : {false, true}) {
    Approach mission;
    mission.FlyTo(mission.parameters.decide_time - 0.05);
    mission.Tick([](MissionInputs& in) { in.horizontal_distance = 5.0; });
    ASSERT_EQ(ModeOf(mission), MissionMode::kGoAround);
    mission.Run(mission.parameters.contact_time + 0.3, [&](MissionInputs& in) {
      in.lands = lands;
      in.height = 0.0;
      in.horizontal_distance = 0.1;
      in.foot_force = 2.0 * MissionParameters{}.contact_force;
      in.plan_failed_for = 1.0;
    });
    EXPECT_EQ(ModeOf(mission) == MissionMode::kDisarmed, lands);
  }
}

TEST(PlannedDescent, InAGustItArrivesAboveThePadAndLandsInALull) {
  Approach mission;
  mission.in.lean = mission.parameters.lean_max + 0.1;
  mission.FlyTo(mission.parameters.decide_time - 0.05);
  EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
  mission.in.lean = 0.0;
  mission.Tick();
  EXPECT_EQ(mission.outputs.guidance, Guidance::kTouchDown);
}

TEST(PlannedDescent, IsDecidedWithAnOpenGateAndEndsByContact) {
  Approach mission;
  mission.FlyTo(mission.parameters.decide_time + 0.05);
  EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
  mission.FlyTo(mission.parameters.decide_time - 0.05);
  EXPECT_EQ(ModeOf(mission), MissionMode::kLanding);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kTouchDown);
  EXPECT_FALSE(mission.outputs.committed);
  mission.FlyTo(mission.parameters.arrival_commit_time - 0.05);
  EXPECT_TRUE(mission.outputs.committed);
  mission.FlyTo(0.0);
  EXPECT_EQ(ModeOf(mission), MissionMode::kLanding) << "a plan that is over is no contact";
  mission.Run(mission.parameters.contact_time + 0.1,
              [](MissionInputs& in) { in.foot_force = 10.0; });
  EXPECT_EQ(ModeOf(mission), MissionMode::kDisarmed);
}

TEST(PlannedDescent, WithAClosedGateItArrivesAboveThePadAndComesDownFromThere) {
  Approach mission;
  const auto unseen = [](MissionInputs& in) { in.tag_age = 5.0; };
  mission.FlyTo(mission.parameters.decide_time - 0.05, unseen);
  EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
  const auto above = [](MissionInputs& in) {
    in.arrival_in = kNever;
    in.height = 1.5;
    in.horizontal_distance = 0.1;
  };
  mission.Run(1.0, above);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
  EXPECT_NEAR(mission.outputs.foot_height, mission.parameters.follow_height, 1e-9);
  mission.in.tag_age = 0.05;
  mission.Run(0.05, above);
  EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kTouchDown);
}

TEST(PlannedDescent, IsNotDecidedOutsideTheCone) {
  Approach mission;
  mission.FlyTo(0.5, [](MissionInputs& in) { in.horizontal_distance = 4.0; });
  EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
}

TEST(PlannedDescent, BelowTheGateHeightIsNoPlaceToWait) {
  Approach mission;
  mission.FlyTo(3.0, [](MissionInputs& in) {
    in.tag_age = 5.0;
    in.height = 0.9;
    in.horizontal_distance = 0.5;
  });
  EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
}

// The rest of the descent once its end is requested: until then it goes on at its rate.
TEST(PlannedDescent, TurnsSoFarAboveTheGateHeightThatItEndsThere) {
  for (const double sink_rate : {-1.0, 0.0, 0.6, 1.6}) {
    Approach mission;
    const MissionParameters& p = mission.parameters;
    double turned_at = 0.0;
    for (double height = 4.0; height > 0.0 && turned_at == 0.0; height -= 0.01) {
      mission.Tick([&](MissionInputs& in) {
        in.arrival_in = 10.0;
        in.tag_age = 5.0;
        in.height = height;
        in.sink_rate = sink_rate;
        in.horizontal_distance = 0.1;
      });
      if (mission.outputs.guidance == Guidance::kFollowPad) turned_at = height;
    }
    const double sinks = std::max(0.0, sink_rate);
    const double way = sinks * p.turn_time + sinks * sinks / (2.0 * p.turn_acceleration);
    EXPECT_NEAR(turned_at, p.gate_height + way, 0.02) << sink_rate;
  }
}

TEST(PlannedDescent, OnHighItIsTheTimeThatEndsItWithAClosedGate) {
  Approach mission;
  const auto high = [&](double arrival) {
    mission.Tick([&](MissionInputs& in) {
      in.arrival_in = arrival;
      in.tag_age = 5.0;
      in.height = 3.0;
      in.horizontal_distance = 0.1;
    });
    return mission.outputs.guidance;
  };
  EXPECT_EQ(high(mission.parameters.decide_time + 0.1), Guidance::kTouchDown);
  EXPECT_EQ(high(mission.parameters.decide_time - 0.1), Guidance::kFollowPad);
}

// However suddenly the contact comes near.
TEST(PlannedDescent, IsNeverDecidedWithAClosedGateOrAPadThatIsNotGood) {
  const Mission::Change unseen = [](MissionInputs& in) { in.tag_age = 5.0; };
  const Mission::Change vague = [](MissionInputs& in) { in.pad_converged = false; };
  for (const Mission::Change& lack : {unseen, vague}) {
    Approach mission;
    mission.Run(0.5, [&](MissionInputs& in) {
      in.arrival_in = 0.6;
      in.height = 0.8;
      in.horizontal_distance = 0.1;
      lack(in);
    });
    EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
  }
}

TEST(PlannedDescent, AfterAGoAroundItComesDownAgainOnlyWithAnOpenGate) {
  Approach mission;
  mission.FlyTo(0.9);
  const auto unseen = [](MissionInputs& in) {
    in.tag_age = 5.0;
    in.arrival_in = kNever;
    in.horizontal_distance = 0.1;
  };
  mission.height_follows = true;
  mission.Run(6.0, unseen);
  ASSERT_EQ(ModeOf(mission), MissionMode::kTracking);
  EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
  mission.Run(0.05, [](MissionInputs& in) { in.tag_age = 0.05; });
  EXPECT_EQ(mission.outputs.guidance, Guidance::kTouchDown);
}

TEST(PlannedDescent, ContactIsAsNearAsThePlanSaysAndAReserve) {
  const MissionParameters p;
  MissionInputs in = Fine();
  in.descent = DescentStyle::kPlanned;
  in.arrival_in = 0.5;
  EXPECT_DOUBLE_EQ(ContactIn({}, in, p), 0.5 + p.contact_reserve);
  in.arrival_in = -0.5;
  EXPECT_DOUBLE_EQ(ContactIn({}, in, p), p.contact_reserve);
  in.arrival_in = kNever;
  EXPECT_EQ(ContactIn({}, in, p), kNever);
}

TEST(PlannedDescent, AShortLossOfTheTagsIsBridged) {
  Approach mission;
  mission.FlyTo(0.9);
  ASSERT_EQ(ModeOf(mission), MissionMode::kLanding);
  mission.FlyTo(0.0, [](MissionInputs& in) {
    in.contact_sigma = 0.05;
    in.tag_age = 1.0 - in.arrival_in;
  });
  EXPECT_EQ(ModeOf(mission), MissionMode::kLanding);
  EXPECT_TRUE(mission.outputs.committed);
}

// Each way to lose a landing that has been decided on, at once or after its timeout.
struct Loss {
  const char* name;
  double when;  ///< before contact [s]
  Mission::Change change;
  TransitionReason reason;
};

void PrintTo(const Loss& loss, std::ostream* stream) { *stream << loss.name; }

class LostLanding : public testing::TestWithParam<Loss> {};

TEST_P(LostLanding, EndsInAClimb) {
  const Loss& loss = GetParam();
  Approach mission;
  mission.FlyTo(loss.when);
  ASSERT_EQ(ModeOf(mission), MissionMode::kLanding);
  const double height = mission.in.height;
  TransitionReason reason = TransitionReason::kNone;
  const auto along = [&](MissionInputs& in) {
    in.arrival_in = mission.contact_t - in.t;
    loss.change(in);
  };
  for (int k = 0; k < 400 && reason == TransitionReason::kNone; ++k) {
    mission.Tick(along);
    reason = mission.outputs.reason;
  }
  EXPECT_EQ(reason, loss.reason);
  EXPECT_EQ(ModeOf(mission), MissionMode::kGoAround);
  EXPECT_TRUE(mission.outputs.motors_armed);
  EXPECT_NEAR(mission.outputs.foot_height, height, 0.05) << "a climb begins where the vehicle is";
  mission.Run(0.5, along);
  EXPECT_GT(mission.outputs.foot_height, height);
}

INSTANTIATE_TEST_SUITE_P(
    PlannedDescent, LostLanding,
    testing::Values(
        Loss{"tags", 0.9, [](MissionInputs& in) { in.tag_age = 5.0; }, TransitionReason::kTagsLost},
        Loss{"vague_pad", 0.9,
             [](MissionInputs& in) {
               in.pad_sigma = 0.5;
               in.contact_sigma = 0.5;
             },
             TransitionReason::kTagsLost},
        Loss{"beside", 0.9, [](MissionInputs& in) { in.horizontal_distance = 5.0; },
             TransitionReason::kErrorTooLarge},
        Loss{"beside_committed", 0.2, [](MissionInputs& in) { in.horizontal_distance = 1.0; },
             TransitionReason::kErrorTooLarge},
        Loss{"too_fast", 0.2, [](MissionInputs& in) { in.horizontal_speed = 2.5; },
             TransitionReason::kTooFast},
        Loss{"too_fast_for_the_time_left", 0.05,
             [](MissionInputs& in) { in.horizontal_speed = 1.2; }, TransitionReason::kTooFast},
        Loss{"too_fast_without_a_plan", 0.2,
             [](MissionInputs& in) {
               in.horizontal_speed = 1.2;
               in.arrival_in = kNever;
             },
             TransitionReason::kTooFast},
        Loss{"gust", 0.9, [](MissionInputs& in) { in.lean = 1.6; }, TransitionReason::kGust},
        Loss{"gust_committed", 0.05, [](MissionInputs& in) { in.lean = 1.6; },
             TransitionReason::kGust},
        Loss{"put_off_for_ever", 0.9, [](MissionInputs& in) { in.arrival_in = 0.6; },
             TransitionReason::kNoContact},
        Loss{"no_plan", 0.95, [](MissionInputs& in) { in.plan_failed_for = 0.5; },
             TransitionReason::kPlanFailed},
        Loss{"overdue", 0.05, [](MissionInputs&) {}, TransitionReason::kNoContact},
        Loss{"own_state", 0.9, [](MissionInputs& in) { in.own_usable = false; },
             TransitionReason::kOwnStateLost}),
    [](const auto& test) { return test.param.name; });

TEST(PlannedDescent, SpeedThatCanStillBeTakenOffIsNotTooFast) {
  Approach mission;
  mission.FlyTo(0.35);
  ASSERT_TRUE(mission.outputs.committed);
  mission.FlyTo(0.2, [](MissionInputs& in) { in.horizontal_speed = 1.5; });
  EXPECT_EQ(ModeOf(mission), MissionMode::kLanding);
}

// A climb that begins so late ends with feet that bounce off the deck.
TEST(PlannedDescent, FeetThatWillTouchAnywayArriveOverAKnownDeckAlone) {
  struct Case {
    bool committed, over_deck, known;
    double above;  // where a climb would come just in time, by the lowest foot [m]
    double drop;   // of that foot [m]
    bool arrives;
  };
  for (const Case& c :
       {Case{true, true, true, -0.01, 0.0, true}, Case{false, true, true, -0.01, 0.0, true},
        Case{true, true, true, 0.01, 0.0, false}, Case{false, true, true, 0.01, 0.0, false},
        Case{true, false, true, -0.01, 0.0, false}, Case{true, true, false, -0.01, 0.0, false},
        Case{true, true, true, 0.03, 0.04, true}, Case{true, true, true, -0.30, 0.0, false}}) {
    Approach mission;
    mission.FlyTo(c.committed ? 0.3 : 0.6);
    ASSERT_EQ(mission.outputs.committed, c.committed);
    const MissionParameters& p = mission.parameters;
    mission.Tick([&](MissionInputs& in) {
      in.sink_rate = 0.3;
      in.height = in.sink_rate * p.climb_time +
                  in.sink_rate * in.sink_rate / (2.0 * p.turn_acceleration) + 0.02 + c.above;
      in.foot_drop = c.drop;
      in.horizontal_distance = p.foothold + (c.over_deck ? -0.01 : 0.01);
      in.lean = 1.6;
      if (!c.known) in.pad_sigma = p.bridge_sigma + 0.01;
      if (c.committed) return;
      in.tag_age = 5.0;
      in.contact_sigma = 1.0;
    });
    EXPECT_EQ(ModeOf(mission), c.arrives ? MissionMode::kLanding : MissionMode::kGoAround)
        << c.committed << c.over_deck << c.known << " " << c.above;
  }
}

TEST(PlannedDescent, FeetThatTouchAreNotPulledOffAgain) {
  Approach mission;
  mission.FlyTo(0.05);
  ASSERT_TRUE(mission.outputs.committed);
  mission.parameters.contact_time = 4.0;
  mission.Run(2.5, [&](MissionInputs& in) {
    in.arrival_in = mission.contact_t - in.t;
    in.height = 0.0;
    in.horizontal_distance = 1.0;
    in.horizontal_speed = 2.0;
    in.foot_force = 10.0;
    in.tag_age = 9.0;
  });
  EXPECT_EQ(ModeOf(mission), MissionMode::kLanding);
}

// At whatever height it was given up: no climb begins below the pad's surface.
TEST(PlannedDescent, AClimbBeginsBetweenDeckAndFollowHeight) {
  for (const double height : {-0.2, 2.5}) {
    Approach mission;
    mission.FlyTo(0.9);
    mission.Run(0.02, [&](MissionInputs& in) {
      in.height = height;
      in.horizontal_distance = 0.1;
    });
    ASSERT_EQ(ModeOf(mission), MissionMode::kLanding);
    EXPECT_GE(mission.outputs.foot_height, 0.0);
    EXPECT_LE(mission.outputs.foot_height, mission.parameters.follow_height);
  }
}

TEST(PlannedDescent, OtherStylesDoNotLeadToContactWhileTracking) {
  for (const DescentStyle style : {DescentStyle::kNone, DescentStyle::kVertical}) {
    Mission mission;
    mission.in.descent = style;
    mission.Run(1.0, [](MissionInputs& in) { in.arrival_in = 0.5; });
    EXPECT_EQ(mission.outputs.guidance, Guidance::kFollowPad);
    EXPECT_EQ(ModeOf(mission), MissionMode::kTracking);
  }
}

}  // namespace
}  // namespace touchdown::control
