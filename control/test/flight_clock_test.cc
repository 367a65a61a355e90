// SPDX-License-Identifier: BSD-3-Clause
#include "control/onboard/flight_clock.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace touchdown::control {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FlightClock Begun(double t) {
  FlightClock clock;
  clock.Begin(t);
  return clock;
}

TEST(FlightClock, GoesOnByTheCallersTime) {
  FlightClock clock = Begun(3.0);
  for (const double t : {3.0, 3.002, 3.1, 3.19}) {
    EXPECT_EQ(clock.Step(t), StepTime::kGood) << t;
    EXPECT_EQ(clock.At(t), t);
  }
}

TEST(FlightClock, TheFirstStepIsJudgedByTheBegin) {
  FlightClock clock = Begun(3.0);
  EXPECT_EQ(clock.Step(2.9), StepTime::kBack);
  EXPECT_EQ(clock.Step(3.2), StepTime::kLeap);
  EXPECT_EQ(clock.Step(3.05), StepTime::kGood);
  EXPECT_EQ(clock.Step(3.05), StepTime::kStands);
}

// Each second one is of another clock, and the last good one decides.
TEST(FlightClock, OneOfTwoClocksIsFollowed) {
  FlightClock clock = Begun(0.0);
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(clock.Step(0.002 * k), StepTime::kGood);
    EXPECT_EQ(clock.Step(1.7e9 + 0.002 * k), StepTime::kLeap);
  }
}

TEST(FlightClock, TimesThatDoNotGoOnAreNoClock) {
  FlightClock stands = Begun(10.0), back = Begun(10.0), far_apart = Begun(10.0);
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(stands.Step(20.0), StepTime::kLeap);
    EXPECT_EQ(back.Step(30.0 - 0.002 * k), StepTime::kLeap);
    EXPECT_EQ(far_apart.Step(11.0 + 0.2 * k), StepTime::kLeap);
  }
}

// Copies and no times between them do not hide five times that do.
TEST(FlightClock, FiveThatGoOnAreOne) {
  FlightClock clock = Begun(0.0);
  clock.Step(0.0);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(clock.Step(4.0 + 0.002 * k), k < 4 ? StepTime::kLeap : StepTime::kResumed);
    EXPECT_EQ(clock.Step(4.0 + 0.002 * k), k < 4 ? StepTime::kLeap : StepTime::kStands);
    EXPECT_EQ(clock.Step(kNan), StepTime::kInvalid);
  }
  EXPECT_EQ(clock.Step(4.01), StepTime::kGood);
}

TEST(FlightClock, AStallHasPassedAndBehindAnotherClockAtLeastALongOne) {
  const auto after = [](double begin, double from) {
    FlightClock clock = Begun(begin);
    clock.Step(begin);
    for (int k = 0; k < 5; ++k) clock.Step(from + 0.002 * k);
    return clock.At(from + 0.008) - begin;
  };
  EXPECT_NEAR(after(5.0, 5.2), 0.208, 1e-12);
  EXPECT_NEAR(after(5.0, 14.9), 9.908, 1e-12);
  EXPECT_NEAR(after(5.0, 15.1), 10.0, 1e-12);
  EXPECT_NEAR(after(5.0, 1.7e9), 10.0, 1e-6);
  EXPECT_NEAR(after(5.0, 4.9), 10.0, 1e-12);
  EXPECT_NEAR(after(1.7e9, 0.0), 10.0, 1e-6);
}

// Whatever comes, the flight's time does not go back, and a clock that goes on again is followed.
TEST(FlightClock, FindsTheWayOutOfAnyDisorder) {
  std::mt19937_64 random(1);
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  FlightClock clock = Begun(1.0);
  double now = 1.0, clocks = 1.0;
  for (int k = 0; k < 200000; ++k) {
    if (draw() < 0.02) clocks = draw() < 0.5 ? 4.1e9 * draw() : clocks + 20.0 * (draw() - 0.5);
    clocks += draw() < 0.1 ? 0.0 : 0.002;
    const double t = draw() < 0.1 ? (draw() < 0.5 ? kNan : 1.2e10 * draw()) : clocks;
    if (!IsFlown(clock.Step(t))) continue;
    EXPECT_GE(clock.At(t), now - 1e-5);
    now = clock.At(t);
  }
  EXPECT_LT(now, 2e5);
  for (int k = 0; k < 5; ++k) clock.Step(7.0 + 0.002 * k);
  EXPECT_EQ(clock.Step(7.01), StepTime::kGood);
}

}  // namespace
}  // namespace touchdown::control
