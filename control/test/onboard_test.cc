// SPDX-License-Identifier: BSD-3-Clause
// What happens to a measurement, whenever and however often it comes.
#include "touchdown/control/onboard/onboard.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/onboard/own_state.h"
#include "control/test/toy_world.h"
#include "touchdown/control/onboard/envelope.h"

namespace touchdown::control {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

OnboardOptions Options() { return LandingOptions(ToyQuadrotor(), ToyWorld::kDeck); }

Onboard Made(const OnboardOptions& options) { return {options, LandingParts(options)}; }

estimation::VehicleState At(double t, const Eigen::Vector3d& p_WB = {0.0, 0.0, 2.0}) {
  estimation::VehicleState state;
  state.t = t;
  state.p_WB = p_WB;
  return state;
}

/// At (0, 0, 2) for so long, in steps of 10 ms; then its flight begins.
Onboard Hovering(double seconds) {
  Onboard onboard = Made(Options());
  for (int k = 0; k <= std::lround(100 * seconds); ++k) onboard.Take(At(0.01 * k));
  onboard.Begin(0.01 * std::lround(100 * seconds),
                Eigen::Vector4d::Constant(0.25 * ToyQuadrotor().HoverThrust()));
  return onboard;
}

std::string Sentence(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Onboard, WhatIsMissingOrOutOfRangeIsNamed) {
  struct Slip {
    std::function<void(OnboardOptions*, OnboardParts*)> make;
    const char* said;
  };
  const Slip slips[] = {
      {[](auto*, auto* parts) { parts->planner.reset(); }, "planner is missing"},
      {[](auto*, auto* parts) { parts->controller.reset(); }, "controller is missing"},
      {[](auto*, auto* parts) { parts->predictor.reset(); }, "predictor is missing"},
      {[](auto* options, auto*) { options->deck_size = 0.3; }, "deck_size is 0.3"},
      {[](auto* options, auto*) { options->replan_rate = 0.0; }, "replan_rate is 0"},
      {[](auto* options, auto*) { options->close_rate = kNan; }, "close_rate is nan"},
      {[](auto* options, auto*) { options->mission_rate = 2000.0; }, "mission_rate is 2000"},
      {[](auto* options, auto*) { options->latency.time = -1.0; }, "latency.time is -1"},
      {[](auto* options, auto*) { options->latency.longest = 0.0; }, "latency.longest is 0"},
      {[](auto* options, auto*) { options->latency.longest = 1e-4; }, "latency.longest is 0.0001"},
      {[](auto* options, auto*) { options->own_clock_ahead = kNan; }, "own_clock_ahead is nan"},
      {[](auto* options, auto*) { options->corridor_radius = 0.0; }, "corridor_radius is 0"},
      {[](auto* options, auto*) { options->history = 0.0; }, "history is 0"},
      {[](auto* options, auto*) { options->start_free = -1.0; }, "start_free is -1"},
      {[](auto* options, auto*) { options->model.mass_kg = 0.0; }, "mass"},
      {[](auto* options, auto*) { options->model.foot_depth = -0.1; }, "foot_depth"},
      {[](auto* options, auto*) { options->pad.max_delay = -1.0; }, "max_delay"},
      {[](auto* options, auto*) { options->envelope.speed = kNan; }, "envelope.speed is nan"},
      {[](auto* options, auto*) { options->envelope.acceleration = 0.0; },
       "envelope.acceleration is 0"},
      {[](auto* options, auto*) { options->envelope.tilt_deg = 90.0; }, "envelope.tilt_deg is 90"},
      {[](auto* options, auto*) { options->envelope.ceiling = -1.0; }, "envelope.ceiling is -1"},
      {[](auto* options, auto*) { options->descent = static_cast<DescentStyle>(7); },
       "descent is 7"},
      {[](auto* options, auto*) { options->to_goal = true; }, "with to_goal"},
  };
  for (const Slip& slip : slips) {
    OnboardOptions options = Options();
    OnboardParts parts = LandingParts(options);
    slip.make(&options, &parts);
    EXPECT_THAT(Sentence([&] { Onboard(options, std::move(parts)); }),
                ::testing::HasSubstr(slip.said));
  }
}

TEST(Onboard, NothingTurnsBeforeTheFlightBegins) {
  Onboard onboard = Made(Options());
  EXPECT_THAT(Sentence([&] { onboard.Begin(0.0, Eigen::Vector4d::Zero()); }),
              ::testing::HasSubstr("own state at t [s] is aligning"));
  onboard.Take(At(0.0));
  EXPECT_FALSE(onboard.Step(0.0).armed);
  EXPECT_EQ(onboard.Step(0.1).thrusts, Eigen::Vector4d::Zero());
  onboard.Begin(0.0, Eigen::Vector4d::Constant(2.9));
  EXPECT_TRUE(onboard.Step(0.2).armed);
}

TEST(Onboard, TimeThatStandsGivesTheLastSetpointAgain) {
  Onboard onboard = Hovering(0.1);
  const Setpoint first = onboard.Step(0.1);
  for (const double t : {0.1, 0.05, kNan, std::numeric_limits<double>::infinity()}) {
    const Setpoint again = onboard.Step(t);
    EXPECT_EQ(again.t, first.t) << t;
    EXPECT_EQ(again.thrusts, first.thrusts) << t;
  }
}

TEST(Onboard, GivenStatesComeInAnyOrder) {
  Onboard onboard = Made(Options());
  EXPECT_EQ(onboard.Take(At(1.0, {1, 0, 2})), Taken::kUsed);
  EXPECT_EQ(onboard.Take(At(1.2, {3, 0, 2})), Taken::kUsed);
  EXPECT_EQ(onboard.Take(At(1.1, {2, 0, 2})), Taken::kUsed);  // fills in how it was
  EXPECT_EQ(onboard.Take(At(1.1, {9, 0, 2})), Taken::kDoubled);
  EXPECT_EQ(onboard.own().p_WB.x(), 3.0);
  EXPECT_EQ(onboard.OwnAt(1.1).p_WB.x(), 2.0);
  onboard.Begin(1.2, Eigen::Vector4d::Constant(2.9));
  EXPECT_EQ(onboard.Take(At(0.1)), Taken::kTooOld);
  EXPECT_EQ(onboard.Take(At(kNan)), Taken::kInvalid);
  EXPECT_EQ(onboard.Take(At(1.3, {kNan, 0, 2})), Taken::kInvalid);
  estimation::VehicleState turned = At(1.3);
  turned.q_WB.coeffs() *= 2.0;
  EXPECT_EQ(onboard.Take(turned), Taken::kInvalid);
  EXPECT_EQ(onboard.Take(estimation::ImuSample{1.3, {0, 0, 9.81}, {0, 0, 0}}), Taken::kUnasked);
  EXPECT_EQ(onboard.taken()[static_cast<int>(Taken::kUsed)], 3);
  EXPECT_EQ(onboard.taken()[static_cast<int>(Taken::kInvalid)], 3);
}

TEST(Onboard, BetweenGivenStatesAndShortlyAfterItGoesOnAsItWent) {
  Onboard onboard = Made(Options());
  estimation::VehicleState state = At(1.0);
  state.v_WB = {2.0, 0.0, 0.0};
  state.w_WB_B = {0.0, 0.0, 1.0};
  onboard.Take(state);
  EXPECT_NEAR(onboard.OwnAt(1.05).p_WB.x(), 0.1, 1e-12);
  EXPECT_NEAR(estimation::Yaw(onboard.OwnAt(1.05).q_WB), 0.05, 1e-12);
  EXPECT_NEAR(onboard.OwnAt(9.0).p_WB.x(), 0.2, 1e-12);  // no longer than 0.1 s
}

// One state from far ahead must not make all later ones too old.
TEST(Onboard, AStateFromTheFutureIsRefused) {
  Onboard onboard = Hovering(0.1);
  onboard.Step(0.1);
  EXPECT_EQ(onboard.Take(At(100.0)), Taken::kInvalid);
  EXPECT_EQ(onboard.Take(At(0.2)), Taken::kUsed);
  EXPECT_EQ(onboard.own().t, 0.2);
}

// Before the first step the time is not known: states far ahead are forgotten at the first step.
TEST(Onboard, AWrongStateBeforeTheFirstStepDoesNotBlindIt) {
  Onboard onboard = Hovering(0.1);
  onboard.Take(At(1e6, {9, 9, 9}));
  onboard.Step(0.12);
  EXPECT_EQ(onboard.Take(At(0.13)), Taken::kUsed);
  onboard.Step(0.13);
  EXPECT_EQ(onboard.own().p_WB.x(), 0.0);
  EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kGood);
}

TEST(Onboard, AWrongStateBeforeTheFlightIsNotFlownTo) {
  Onboard onboard = Made(Options());
  for (int k = 0; k <= 10; ++k) onboard.Take(At(0.01 * k));
  onboard.Take(At(1e6, {9, 9, 9}));
  onboard.Begin(0.1, Eigen::Vector4d::Constant(2.9));
  onboard.Step(0.102);
  EXPECT_EQ(onboard.own().p_WB.x(), 0.0);
  EXPECT_EQ(onboard.Reference(0.2).p_WB.x(), 0.0);
  EXPECT_FALSE(onboard.map().IsObservedFree(onboard.map().CellOf({9, 9, 9})));
  EXPECT_TRUE(onboard.map().IsObservedFree(onboard.map().CellOf({0, 0, 2})));
}

// Two clocks that have nothing in common.
TEST(Onboard, WithStatesOfAnotherTimeNoFlightBegins) {
  Onboard onboard = Made(Options());
  onboard.Take(At(1.7e9));
  const auto begin = [&] { onboard.Begin(10.0, Eigen::Vector4d::Constant(2.9)); };
  EXPECT_THAT(Sentence(begin), ::testing::HasSubstr("aligning"));
  EXPECT_EQ(onboard.Take(At(1.7e9 + 0.01)), Taken::kInvalid);
  onboard.Take(At(10.0));
  EXPECT_NO_THROW(begin());
}

TEST(Onboard, WithAnImuOfAnotherTimeNoFlightBegins) {
  OnboardOptions options = Options();
  options.own_state.emplace();
  Onboard onboard = Made(options);
  onboard.Take(estimation::ImuSample{0.0, {0, 0, 9.81}, {0, 0, 0}});
  onboard.Take(estimation::OwnPositionFix{0.0, {1, 2, 3}, 0.05, 0.05});
  onboard.Take(estimation::HeadingSample{0.0, 0.1, 0.03});
  onboard.Take(estimation::ImuSample{1e6, {0, 0, 9.81}, {0, 0, 0}});
  EXPECT_THAT(Sentence([&] { onboard.Begin(2.0, Eigen::Vector4d::Constant(2.9)); }),
              ::testing::HasSubstr("imu_stale"));
}

// ... and the true ones that come after it are not too old.
TEST(Onboard, AWrongStateBeforeTheFlightDoesNotShutOutTheTrueOnes) {
  Onboard onboard = Made(Options());
  EXPECT_EQ(onboard.Take(At(1.7e9, {9, 9, 9})), Taken::kUsed);
  for (int k = 0; k <= 10; ++k) EXPECT_EQ(onboard.Take(At(0.01 * k)), Taken::kUsed);
  onboard.Begin(0.1, Eigen::Vector4d::Constant(2.9));
  EXPECT_EQ(onboard.own().p_WB, Eigen::Vector3d(0.0, 0.0, 2.0));
}

TEST(Onboard, AStateThatNoVehicleHasIsInvalid) {
  Onboard onboard = Hovering(0.1);
  const auto taken = [&](const std::function<void(estimation::VehicleState*)>& spoil) {
    estimation::VehicleState state = At(0.15);
    spoil(&state);
    return onboard.Take(state);
  };
  EXPECT_EQ(taken([](auto* s) { s->p_WB.x() = 1e200; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* s) { s->v_WB.y() = -1e200; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* s) { s->w_WB_B.z() = 1e200; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* s) { s->t = -1.0; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto*) {}), Taken::kUsed);
}

TEST(Onboard, ItsMemoryCanBeTakenTwice) {
  Onboard onboard = Hovering(0.1);
  ToyWorld world;
  world.wall = {Eigen::Vector3d(3.0, -1.0, 0.0), Eigen::Vector3d(3.4, 1.0, 3.0)};
  world.vehicle = At(0.1);
  EXPECT_EQ(onboard.Take(world.Depth()), Taken::kUsed);
  EXPECT_GT(onboard.TakeMemory().size(), 0u);
  EXPECT_EQ(onboard.TakeMemory().size(), 0u);
  onboard.Step(0.12);
}

TEST(Onboard, AStateThatIsLateDoesNotTurnTimeBack) {
  Onboard onboard = Hovering(0.1);
  onboard.Step(0.2);
  EXPECT_EQ(onboard.Take(At(0.142, {0.1, 0, 2})), Taken::kUsed);
  EXPECT_EQ(onboard.own().t, 0.2);
  EXPECT_EQ(onboard.own().p_WB.x(), 0.1);
  EXPECT_EQ(onboard.Take(estimation::FootForce{0.2, 1.0}), Taken::kUsed);
}

// A state from a little ahead waits for its time; the true ones are flown by until then.
TEST(Onboard, AStateFromALittleAheadDoesNotStandForNow) {
  Onboard onboard = Hovering(0.1);
  onboard.Step(0.1);
  onboard.Take(At(0.19, {5, 0, 2}));
  onboard.Take(At(0.12, {0.1, 0, 2}));
  onboard.Step(0.12);
  EXPECT_EQ(onboard.own().t, 0.12);
  EXPECT_EQ(onboard.own().p_WB.x(), 0.1);
  EXPECT_EQ(onboard.Take(At(0.3)), Taken::kInvalid);
}

TEST(Onboard, AForceFromTheFutureIsRefused) {
  Onboard onboard = Hovering(0.1);
  EXPECT_EQ(onboard.Take(estimation::FootForce{1e9, 9.0}), Taken::kInvalid);
  EXPECT_EQ(onboard.Take(estimation::FootForce{0.1, 0.0}), Taken::kUsed);
}

TEST(Onboard, AForceBeforeTheOwnStateIsUnasked) {
  Onboard onboard = Made(Options());
  EXPECT_EQ(onboard.Take(estimation::FootForce{1e9, 9.0}), Taken::kUnasked);
}

// A sensor that fails under load would report that load for ever.
TEST(Onboard, AForceIsForgotten) {
  Onboard onboard = Hovering(0.1);
  onboard.Step(0.1);
  onboard.Take(estimation::FootForce{0.1, 9.0});
  const auto pressed = [&](double t) {
    onboard.Take(At(t));
    onboard.Step(t);
    return onboard.status().foot_force;
  };
  EXPECT_EQ(pressed(0.15), 9.0);
  EXPECT_EQ(pressed(0.25), 0.0);
}

TEST(Onboard, AStepOfAnotherTimeIsRefusedAndNamed) {
  const std::pair<double, StepTime> times[] = {
      {kNan, StepTime::kInvalid}, {-1.0, StepTime::kInvalid}, {1e300, StepTime::kInvalid},
      {0.1, StepTime::kStands},   {0.05, StepTime::kBack},    {0.201, StepTime::kLeap},
      {5.0, StepTime::kLeap},     {1.7e9, StepTime::kLeap}};
  for (const auto& [wrong, judged] : times) {
    Onboard onboard = Hovering(0.1);
    const double good = onboard.Step(0.1).t;
    EXPECT_EQ(onboard.Step(wrong).t, good) << wrong;
    EXPECT_EQ(onboard.status().time, judged) << wrong;
    EXPECT_FALSE(onboard.status().mission_step);
    EXPECT_NE(onboard.Take(At(wrong)), Taken::kUsed) << wrong;
    EXPECT_EQ(onboard.Take(At(0.102, {0.1, 0, 2})), Taken::kUsed);
    EXPECT_EQ(onboard.Step(0.102).t, 0.102);
    EXPECT_EQ(onboard.status().time, StepTime::kGood);
    EXPECT_EQ(onboard.own().p_WB.x(), 0.1);
    EXPECT_EQ(onboard.steps()[static_cast<std::size_t>(judged)], 1);
  }
}

TEST(Onboard, ASetpointCountsForATenthOfASecond) {
  Onboard onboard = Hovering(0.1);
  const Setpoint& setpoint = onboard.Step(0.12);
  EXPECT_EQ(setpoint.valid_until, 0.12 + 0.1);
  EXPECT_TRUE(setpoint.CountsAt(0.21));
  EXPECT_FALSE(setpoint.CountsAt(0.23));
  EXPECT_FALSE(setpoint.CountsAt(0.12 - 3600.0));  // the clock was set back
  EXPECT_FALSE(setpoint.CountsAt(kNan));
  onboard.Step(9.0);
  EXPECT_EQ(setpoint.valid_until, 0.12 + 0.1);
}

// No step has been taken yet, and the vehicle flies.
TEST(Onboard, ARefusedFirstStepDoesNotStopTheRotors) {
  Onboard onboard = Hovering(0.1);
  const Setpoint& setpoint = onboard.Step(1.7e9);
  EXPECT_TRUE(setpoint.armed);
  EXPECT_EQ(setpoint.thrusts, Eigen::Vector4d::Constant(0.25 * ToyQuadrotor().HoverThrust()));
  EXPECT_EQ(setpoint.reference.p_WB, Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_EQ(setpoint.t, 0.1);
}

// Ten milliseconds of another time are a stall, and that time has passed.
TEST(Onboard, AStallIsAnOutage) {
  Onboard onboard = Hovering(0.1);
  onboard.Step(0.1);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(onboard.Step(5.0 + 0.002 * k).t, 0.1) << k;
  EXPECT_EQ(onboard.Take(At(5.006)), Taken::kInvalid);
  EXPECT_EQ(onboard.Step(5.008).t, 5.008);
  EXPECT_EQ(onboard.status().time, StepTime::kResumed);
  EXPECT_FALSE(KnowsAttitude(onboard.status().own));
  EXPECT_EQ(onboard.plan().asked, nullptr);
  EXPECT_EQ(onboard.own().t, 5.008);
  EXPECT_EQ(onboard.FlightTime(5.008), 5.008);
  EXPECT_EQ(onboard.Take(At(5.01)), Taken::kUsed);
  onboard.Step(5.01);
  EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kGood);
  EXPECT_EQ(onboard.status().time, StepTime::kGood);
}

// ... and what was tracked before it says nothing of the tracking, though no plan is found at first.
TEST(Onboard, AReferenceThatAStallLostIsNoErrorOfTracking) {
  OnboardOptions options = Options();
  options.estimate_disturbance = false;  // this vehicle bends its path without leaning: gusts
  Onboard onboard = Made(options);
  ToyWorld world;
  world.vehicle = At(0.0);
  world.pad_start = {12.0, 0.0, ToyWorld::kDeck};
  world.pad_velocity.setZero();
  onboard.Take(world.vehicle);
  onboard.Begin(0.0, world.thrusts);
  int failed = 0, planned = 0;
  double largest = 0.0;
  const auto fly = [&](double seconds, bool sees) {  // along the reference
    for (int k = 0; k < std::lround(500.0 * seconds); ++k) {
      onboard.Take(world.vehicle);
      if (k % 50 == 0) onboard.Take(world.PadGps());
      if (sees && k % 50 == 0) onboard.Take(world.Depth());
      const planning::FlatState reference = onboard.Step(world.vehicle.t).reference;
      if (const planning::ReplanResult* answer = onboard.plan().answer) {
        ++(answer->status == planning::ReplanStatus::kPlanned ? planned : failed);
        largest = std::max(largest, onboard.plan().asked->request.input.margins.tracking);
      }
      world.vehicle.p_WB = reference.p_WB;
      world.vehicle.v_WB = reference.v_WB;
      world.vehicle.t += ToyWorld::kStep;
    }
  };
  fly(2.5, true);
  EXPECT_GT(planned, 0);
  EXPECT_GT(world.vehicle.v_WB.norm(), 1.0);
  planned = failed = 0;
  world.vehicle.t += 2.0;  // braked at once
  world.vehicle.v_WB.setZero();
  planning::OccupancyMap before = onboard.map();
  for (double a = -1.2; a <= 1.2; a += 0.1) {  // a room
    for (double b = -1.2; b <= 1.2; b += 0.1) {
      for (const double wall : {-1.2, 1.2}) {
        for (const Eigen::Vector3d& off : {Eigen::Vector3d(wall, a, b), Eigen::Vector3d(a, wall, b),
                                           Eigen::Vector3d(a, b, wall)}) {
          onboard.mutable_map()->SetOccupied(world.vehicle.p_WB + off);
        }
      }
    }
  }
  fly(0.3, false);
  EXPECT_GT(failed, 0);
  EXPECT_EQ(planned, 0);
  *onboard.mutable_map() = before;
  fly(2.0, true);
  EXPECT_GT(planned, 0);
  EXPECT_LT(largest, 0.1);
}

// Nobody knows what has passed when the clock is another one: all that is known gets old.
TEST(Onboard, AClockThatStartsAnewIsFollowed) {
  for (const double anew : {0.0, 4.9, 1.7e9}) {
    Onboard onboard = Made(Options());
    onboard.Take(At(5.0));
    onboard.Begin(5.0, Eigen::Vector4d::Constant(2.9));
    onboard.Step(5.0);
    for (int k = 0; k < 5; ++k) onboard.Step(anew + 0.002 * k);
    EXPECT_EQ(onboard.status().time, StepTime::kResumed) << anew;
    EXPECT_NEAR(onboard.FlightTime(anew + 0.008), 15.0, 1e-6) << anew;
    EXPECT_NE(onboard.Take(At(5.01)), Taken::kUsed) << anew;
    EXPECT_EQ(onboard.Take(At(anew + 0.01, {0.1, 0, 2})), Taken::kUsed) << anew;
    EXPECT_EQ(onboard.Take(estimation::FootForce{anew + 0.01, 0.0}), Taken::kUsed) << anew;
    EXPECT_EQ(onboard.Take(estimation::PadGpsFix{anew + 0.01, {4, 1}, 0.1}), Taken::kUsed) << anew;
    const Setpoint& setpoint = onboard.Step(anew + 0.01);
    EXPECT_EQ(setpoint.t, anew + 0.01);
    EXPECT_EQ(setpoint.valid_until, anew + 0.01 + 0.1);
    EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kGood) << anew;
    EXPECT_EQ(onboard.own().p_WB.x(), 0.1) << anew;
    EXPECT_EQ(onboard.OwnAt(anew + 0.01).p_WB.x(), 0.1) << anew;
  }
}

// The new clock shows a little less: what comes by it seems to be late.
TEST(Onboard, WithoutATimeThePadAndTheObstaclesAreNotMeasured) {
  Onboard onboard = Hovering(0.5);
  onboard.Step(0.5);
  ToyWorld world;
  world.vehicle = At(0.2);
  world.pad_start = {0.0, 0.0, ToyWorld::kDeck};
  EXPECT_EQ(onboard.Step(0.2).t, 0.5);
  EXPECT_EQ(onboard.Take(world.Depth()), Taken::kInvalid);
  EXPECT_EQ(onboard.Take(world.PadGps()), Taken::kInvalid);
  EXPECT_EQ(onboard.Take(world.Sighting()), Taken::kInvalid);
  for (int k = 1; k < 5; ++k) onboard.Step(0.2 + 0.002 * k);
  EXPECT_EQ(onboard.status().time, StepTime::kResumed);
  world.vehicle.t = 0.21;
  onboard.Take(world.vehicle);
  EXPECT_EQ(onboard.Take(world.Depth()), Taken::kUsed);
  EXPECT_EQ(onboard.Take(world.PadGps()), Taken::kUsed);
  EXPECT_EQ(onboard.Take(world.Sighting()), Taken::kUsed);
}

// A clock of few ticks shows each of them for several steps.
TEST(Onboard, ATimeThatStandsShutsNothingOut) {
  Onboard onboard = Hovering(0.1);
  onboard.Step(0.1);
  onboard.Step(0.1);
  EXPECT_EQ(onboard.status().time, StepTime::kStands);
  EXPECT_EQ(onboard.Take(estimation::PadGpsFix{0.1, {4, 1}, 0.1}), Taken::kUsed);
}

// Rotors that stand still do so for however long.
TEST(Onboard, ADisarmedSetpointAlwaysCounts) {
  Onboard onboard = Made(Options());
  for (const double t : {0.0, 1e6, 1.7e9}) EXPECT_TRUE(onboard.Step(t).CountsAt(t));
}

// A tilt asks for a moment. It must not go on for ever.
TEST(Onboard, WithoutAnyTimeItLevelsOut) {
  Onboard onboard = Hovering(0.1);
  estimation::VehicleState tilted = At(0.12);
  tilted.q_WB = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  onboard.Take(tilted);
  const Setpoint& setpoint = onboard.Step(0.12);
  for (int k = 0; k < 49; ++k) onboard.Step(k % 2 == 0 ? kNan : 1e3 * k);
  EXPECT_GT(setpoint.wrench.moment_B.norm(), 0.1);
  EXPECT_FALSE(setpoint.level);
  onboard.Step(kNan);
  EXPECT_TRUE(setpoint.level);
  EXPECT_EQ(setpoint.wrench.moment_B.norm(), 0.0);
  EXPECT_NEAR(setpoint.thrusts.sum(), ToyQuadrotor().HoverThrust(), 0.1);
  EXPECT_TRUE(setpoint.armed);
  EXPECT_EQ(setpoint.t, 0.12);
}

TEST(Onboard, WithoutAnImuNoMomentIsAsked) {
  OnboardOptions options = Options();
  options.own_state.emplace();
  Onboard onboard = Made(options);
  const auto feed = [&](double t) {
    onboard.Take(estimation::OwnPositionFix{t, {1, 2, 3}, 0.05, 0.05});
    onboard.Take(estimation::HeadingSample{t, 0.1, 0.03});
    onboard.Take(estimation::ImuSample{t, {0, 0, 9.81}, {0, 0, 0}});
  };
  for (int k = 0; k <= 600; ++k) feed(0.002 * k);
  onboard.Begin(1.2, Eigen::Vector4d::Constant(2.9));
  feed(1.202);
  EXPECT_GT(onboard.Step(1.202).wrench.moment_B.norm(), 0.0);
  EXPECT_EQ(onboard.Step(1.3).wrench.moment_B.norm(), 0.0);
  EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kImuStale);
  feed(1.302);
  onboard.Step(1.302);
  EXPECT_NE(onboard.status().own, estimation::OwnStatus::kImuStale);
}

TEST(Onboard, ANegativeSigmaIsInvalid) {
  Onboard onboard = Hovering(0.1);
  EXPECT_EQ(onboard.Take(estimation::PadGpsFix{0.1, {1, 2}, -0.05}), Taken::kInvalid);
}

TEST(Onboard, ASightingOfLessThanNoTagIsInvalid) {
  Onboard onboard = Hovering(0.1);
  estimation::PadSighting sighting{0.1, {0, 0, -1}, 0.0, Eigen::Vector3d::Constant(0.01), 0.01, -1};
  EXPECT_EQ(onboard.Take(sighting), Taken::kInvalid);
  sighting.tags_seen = 1;
  EXPECT_EQ(onboard.Take(sighting), Taken::kUsed);
}

TEST(Onboard, WithoutAnAttitudeNoMomentIsAsked) {
  Onboard onboard = Hovering(0.1);
  estimation::VehicleState tilted = At(0.12);
  tilted.q_WB = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  onboard.Take(tilted);
  EXPECT_GT(onboard.Step(0.12).wrench.moment_B.norm(), 0.1);
  onboard.Step(0.2);
  const Setpoint& blind = onboard.Step(0.25);
  EXPECT_EQ(blind.wrench.moment_B.norm(), 0.0);
  EXPECT_NEAR(blind.wrench.thrust, ToyQuadrotor().HoverThrust(), 0.1);
  EXPECT_EQ(blind.R_WB.col(2).z(), 1.0);
  EXPECT_TRUE(blind.armed);
}

// A corrupt copy does not replace the good one.
TEST(Onboard, WhatWasInvalidMayComeAgain) {
  Onboard onboard = Hovering(1.0);
  EXPECT_EQ(onboard.Take(estimation::PadGpsFix{0.5, {kNan, 1.0}, 0.05}), Taken::kInvalid);
  EXPECT_EQ(onboard.Take(estimation::PadGpsFix{0.5, {5.0, 1.0}, 0.05}), Taken::kUsed);
  EXPECT_EQ(onboard.Take(estimation::PadGpsFix{0.5, {5.0, 1.0}, 0.05}), Taken::kDoubled);
}

TEST(Onboard, ASightingFromBeforeTheHistoryIsTooOld) {
  Onboard onboard = Made(Options());
  onboard.Take(At(5.0));
  estimation::PadSighting sighting{4.8, {0, 0, -1}, 0.0, Eigen::Vector3d::Constant(0.01), 0.01, 5};
  EXPECT_EQ(onboard.Take(sighting), Taken::kTooOld);
  sighting.t = 5.0;
  EXPECT_EQ(onboard.Take(sighting), Taken::kUsed);
}

// Sensors other than the IMU: fused once, however often they come.
TEST(Onboard, DoublesOfTheOwnSensorsChangeNothing) {
  OnboardOptions options = Options();
  options.own_state.emplace();
  Onboard once = Made(options), twice = Made(options);
  const auto feed = [](Onboard* onboard, int copies) {
    for (int k = 0; k <= 1500; ++k) {
      const double t = 0.002 * k;
      for (int i = 0; i < copies; ++i) {
        onboard->Take(estimation::ImuSample{t, {0, 0, 9.81}, {0, 0, 0}});
        if (k % 50 == 0) onboard->Take(estimation::OwnPositionFix{t, {1, 2, 3}, 0.05, 0.05});
        if (k % 20 == 0) onboard->Take(estimation::HeightSample{t, 3.0, 0.1});
        if (k % 20 == 0) onboard->Take(estimation::HeadingSample{t, 0.1, 0.03});
        if (k % 25 == 0) onboard->Take(estimation::OwnVelocityFix{t, {0, 0, 0}, 0.05});
      }
    }
  };
  feed(&once, 1);
  feed(&twice, 2);
  EXPECT_EQ(once.own().p_WB, twice.own().p_WB);
  EXPECT_EQ(once.own().q_WB.coeffs(), twice.own().q_WB.coeffs());
  EXPECT_EQ(once.taken()[static_cast<int>(Taken::kDoubled)], 0);
  EXPECT_EQ(twice.taken()[static_cast<int>(Taken::kDoubled)], 1501 + 31 + 76 + 76 + 61);
}

// A fast vehicle may land on a fast pad.
TEST(Onboard, ThePadsSpeedFollowsFromTheEnvelope) {
  Envelope fast;
  fast.speed = 12.0;
  EXPECT_EQ(LandingOptions(ToyQuadrotor(), ToyWorld::kDeck, fast).pad.speed_prior,
            fast.PadSpeedPrior());
  EXPECT_LT(Options().pad.speed_prior, fast.PadSpeedPrior());
}

TEST(Onboard, AFlightBeginsOnceAndWithThrusts) {
  Onboard onboard = Made(Options());
  onboard.Take(At(0.0));
  for (const double wrong : {kNan, -1.0, 100.0}) {
    EXPECT_THAT(Sentence([&] { onboard.Begin(0.0, Eigen::Vector4d(2.9, wrong, 2.9, 2.9)); }),
                ::testing::HasSubstr("thrusts"));
  }
  EXPECT_FALSE(onboard.Step(0.1).armed);
  onboard.Begin(0.0, Eigen::Vector4d::Constant(2.9));
  EXPECT_THAT(Sentence([&] { onboard.Begin(0.0, Eigen::Vector4d::Constant(2.9)); }),
              ::testing::HasSubstr("has begun"));
}

// Without a newer state the vehicle does not know where it is.
TEST(Onboard, AStateThatStopsComingIsSaid) {
  Onboard onboard = Hovering(0.1);
  onboard.Step(0.15);
  EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kGood);
  onboard.Step(0.25);
  EXPECT_EQ(onboard.status().own, estimation::OwnStatus::kImuStale);
}

TEST(Onboard, AnEstimatedStateIsNotGiven) {
  OnboardOptions options = Options();
  options.own_state.emplace();
  Onboard onboard = Made(options);
  EXPECT_EQ(onboard.Take(At(0.0)), Taken::kUnasked);
  EXPECT_EQ(onboard.Take(estimation::PadGpsFix{0.0, {1, 2}, 0.1}), Taken::kUnasked);
  EXPECT_EQ(onboard.Take(estimation::ImuSample{0.0, {0, 0, 9.81}, {0, 0, 0}}), Taken::kWaiting);
}

TEST(Onboard, ThePadsMeasurementsComeInAnyOrder) {
  const auto fix = [](double t) { return estimation::PadGpsFix{t, {5.0 + t, 1.0}, 0.05}; };
  Onboard straight = Hovering(1.0), mixed = Hovering(1.0);
  for (const double t : {0.5, 0.6, 0.7, 0.8, 0.9}) EXPECT_EQ(straight.Take(fix(t)), Taken::kUsed);
  for (const double t : {0.5, 0.7, 0.6, 0.9, 0.8}) EXPECT_EQ(mixed.Take(fix(t)), Taken::kUsed);
  EXPECT_EQ(straight.pad().belief().mean, mixed.pad().belief().mean);
  EXPECT_EQ(straight.pad().belief().cov, mixed.pad().belief().cov);
  EXPECT_EQ(mixed.Take(fix(0.7)), Taken::kDoubled);
  EXPECT_EQ(mixed.Take(fix(0.9)), Taken::kDoubled);
  EXPECT_EQ(straight.pad().belief().cov, mixed.pad().belief().cov);
  EXPECT_EQ(mixed.Take(fix(5.0)), Taken::kInvalid);  // ahead of time
  EXPECT_EQ(mixed.Take(fix(kNan)), Taken::kInvalid);
  EXPECT_EQ(mixed.Take(fix(0.01)), Taken::kTooOld);
}

TEST(Onboard, AnImageIsPlacedWhereTheVehicleWasThen) {
  Onboard onboard = Made(Options());
  ToyWorld world;
  world.wall = {Eigen::Vector3d(3.0, -1.0, 0.0), Eigen::Vector3d(3.4, 1.0, 3.0)};
  world.vehicle = At(0.0);
  onboard.Take(world.vehicle);
  const estimation::DepthImage image = world.Depth();
  onboard.Take(At(0.3, {1.5, 0.0, 2.0}));
  onboard.Begin(0.3, Eigen::Vector4d::Constant(2.9));
  EXPECT_EQ(onboard.Take(image), Taken::kUsed);
  const auto occupied = [&](double x) {
    return onboard.map().IsOccupied(onboard.map().CellOf({x, 0.05, 2.05}));
  };
  EXPECT_TRUE(occupied(3.05));
  EXPECT_FALSE(occupied(4.55));
  EXPECT_EQ(onboard.Take(image), Taken::kDoubled);
}

// Two cameras take their images at the same time; each image counts once.
TEST(Onboard, EveryDepthCameraHasItsOwnImages) {
  Onboard onboard = Hovering(2.0);
  ToyWorld world;
  world.vehicle = At(2.0);
  const estimation::DepthImage ahead = world.Depth();
  estimation::DepthImage down = ahead;
  down.p_BC = {0.0, 0.0, -0.05};
  down.R_BC = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()) * ahead.R_BC;
  EXPECT_EQ(onboard.Take(ahead), Taken::kUsed);
  EXPECT_EQ(onboard.Take(down), Taken::kUsed);
  EXPECT_EQ(onboard.Take(ahead), Taken::kDoubled);
  EXPECT_EQ(onboard.Take(down), Taken::kDoubled);
  for (int i = 1; i < 20; ++i) {  // more than are remembered
    down.p_BC.x() = 0.01 * i;
    EXPECT_EQ(onboard.Take(down), Taken::kUsed);
  }
}

TEST(Onboard, AnImageThatIsNoneIsRefused) {
  Onboard onboard = Hovering(2.0);
  ToyWorld world;
  world.vehicle = At(2.0);
  const estimation::DepthImage good = world.Depth();
  const auto taken = [&](const std::function<void(estimation::DepthImage*)>& spoil) {
    estimation::DepthImage image = good;
    spoil(&image);
    return onboard.Take(image);
  };
  EXPECT_EQ(taken([](auto* i) { i->depth.pop_back(); }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->depth.clear(); }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->intrinsics.width = -80; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->intrinsics.focal = 0.0; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->max_range = kNan; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->p_BC.x() = kNan; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->p_BC.x() = 1e10; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->intrinsics.cx = kNan; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->intrinsics.cy = 1e308; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->R_BC.setZero(); }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->R_BC.col(0) *= -1.0; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->t = kNan; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->t = 2.2; }), Taken::kInvalid);
  EXPECT_EQ(taken([](auto* i) { i->t = 0.5; }), Taken::kTooOld);
  const auto all = [](float depth) {
    return [depth](auto* i) { std::fill(i->depth.begin(), i->depth.end(), depth); };
  };
  for (const float nothing : {0.0F, -1.0F, 3000.0F, float(kNan), -float(kInfinity)}) {
    EXPECT_EQ(taken(all(nothing)), Taken::kEmpty) << nothing;
  }
  EXPECT_EQ(taken([](auto*) {}), Taken::kUsed);
}

// Most of it is returns from beyond the range.
TEST(Onboard, AnImageInMillimetresSaysNothing) {
  Onboard onboard = Hovering(0.1);
  ToyWorld world;
  world.wall = {Eigen::Vector3d(3.0, -9.0, 0.0), Eigen::Vector3d(3.4, 9.0, 9.0)};
  world.vehicle = At(0.1);
  estimation::DepthImage image = world.Depth();
  for (float& depth : image.depth) depth *= 1000.0F;
  EXPECT_EQ(onboard.Take(image), Taken::kEmpty);
  for (float& depth : image.depth) depth *= 1e-3F;
  EXPECT_EQ(onboard.Take(image), Taken::kUsed);
}

// One impossible pixel does not invalidate the others.
TEST(Onboard, AnImageWithAHotPixelIsUsed) {
  Onboard onboard = Hovering(0.1);
  ToyWorld world;
  world.vehicle = At(0.1);
  estimation::DepthImage image = world.Depth();
  std::fill(image.depth.begin(), image.depth.end(), float(kInfinity));
  image.depth[7] = 60.0F;
  EXPECT_EQ(onboard.Take(image), Taken::kUsed);
}

TEST(Onboard, NoFlightBeginsAboveTheCeiling) {
  OnboardOptions options = Options();
  options.envelope.ceiling = 1.5;
  Onboard onboard = Made(options);
  onboard.Take(At(0.0));
  EXPECT_THAT(Sentence([&] { onboard.Begin(0.0, Eigen::Vector4d::Constant(2.9)); }),
              ::testing::HasSubstr("height of the own state [m] is 2"));
}

// As with the coordinates of a map (UTM): its planner would refuse every step.
TEST(Onboard, NoFlightBeginsAMillionMetresAway) {
  for (const double far : {5.3e6, -5.3e6}) {
    Onboard onboard = Made(Options());
    estimation::VehicleState state = At(0.0);
    state.p_WB.y() = far;
    onboard.Take(state);
    EXPECT_THAT(Sentence([&] { onboard.Begin(0.0, Eigen::Vector4d::Constant(2.9)); }),
                ::testing::HasSubstr("subtract an origin near the flight"));
  }
}

TEST(Onboard, AForceIsOfItsTime) {
  Onboard onboard = Hovering(0.1);
  EXPECT_EQ(onboard.Take(estimation::FootForce{0.05, 1.0}), Taken::kUsed);
  EXPECT_EQ(onboard.Take(estimation::FootForce{0.05, 2.0}), Taken::kDoubled);
  EXPECT_EQ(onboard.Take(estimation::FootForce{0.04, 2.0}), Taken::kTooOld);
  EXPECT_EQ(onboard.Take(estimation::FootForce{0.06, kNan}), Taken::kInvalid);
}

TEST(StepTime, EveryOneHasItsName) {
  std::set<std::string_view> names;
  for (int i = 0; i < kStepTimes; ++i) names.insert(ToString(static_cast<StepTime>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kStepTimes));
}

TEST(Taken, EveryOneHasItsName) {
  std::set<std::string_view> names;
  for (int i = 0; i < kTakenKinds; ++i) names.insert(ToString(static_cast<Taken>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kTakenKinds));
}

}  // namespace
}  // namespace touchdown::control
