// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/sim/pad/pace.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "sim/pad/path_drive.h"

namespace touchdown::sim {
namespace {

std::vector<Pace> Paces() {
  return {Pace({{0.0, 1.0}, {2.0, 5.0}, {2.5, 5.0}, {2.9, 4.0}, {9.0, 20.0}}, 0.7),
          StopAndGoPace(0.8, 4.0, 2.0, 0.5), ReversingPace(3.0, 5.0, 2.0)};
}

TEST(Pace, DerivativesAreThoseOfTheWay) {
  const double h = 1e-4;
  for (const Pace& pace : Paces()) {
    for (double t = -3.0; t < 14.0; t += 0.0371) {
      const PacePoint before = pace.At(t - h), now = pace.At(t), after = pace.At(t + h);
      EXPECT_NEAR((after.s - before.s) / (2.0 * h), now.speed, 1e-6) << t;
      EXPECT_NEAR((after.speed - before.speed) / (2.0 * h), now.acceleration, 1e-5) << t;
      EXPECT_NEAR((after.acceleration - before.acceleration) / (2.0 * h), now.jerk, 2e-2) << t;
    }
  }
}

TEST(Pace, EverythingUpToTheJerkIsContinuousAtKnotsToo) {
  for (const Pace& pace : Paces()) {
    PacePoint last = pace.At(-3.0);
    for (int i = 1; i <= 17000; ++i) {
      const PacePoint now = pace.At(-3.0 + 1e-3 * i);
      ASSERT_LT(std::abs(now.s - last.s), 0.02) << i;
      ASSERT_LT(std::abs(now.speed - last.speed), 0.02) << i;
      ASSERT_LT(std::abs(now.acceleration - last.acceleration), 0.05) << i;
      ASSERT_LT(std::abs(now.jerk - last.jerk), 0.2) << i;
      last = now;
    }
  }
}

TEST(Pace, KeepsItsBoundsAndTheyAreNear) {
  for (const Pace& pace : Paces()) {
    double most = 0.0, jerk = 0.0;
    for (double t = -3.0; t < 30.0; t += 1e-3) {
      const PacePoint now = pace.At(t);
      ASSERT_GE(now.speed, pace.LeastSpeed() - 1e-12);
      ASSERT_LE(now.speed, pace.GreatestSpeed() + 1e-12);
      most = std::max(most, std::abs(now.acceleration));
      jerk = std::max(jerk, std::abs(now.jerk));
    }
    EXPECT_LE(most, pace.MaxAcceleration() * (1.0 + 1e-12));
    EXPECT_LE(jerk, pace.MaxJerk() * (1.0 + 1e-12));
    EXPECT_GT(most, 0.7 * pace.MaxAcceleration());
    EXPECT_GT(jerk, 0.3 * pace.MaxJerk());
  }
}

TEST(Pace, StopAndGoStandsAndDrivesInTurn) {
  const Pace pace = StopAndGoPace(0.8, 6.0, 4.0, 0.5);  // changes take 3.6 s
  EXPECT_NEAR(pace.MaxAcceleration(), 0.5, 1e-12);
  for (const double start : {-70000.0, -10.0, 0.0, 20.0, 700.0, 70000.0}) {
    for (const double t : {0.0, 1.2, 2.4}) {
      EXPECT_NEAR(pace.At(start + t).speed, 0.8, 1e-12) << start;
      EXPECT_NEAR(pace.At(start + t).s, 0.48 * start + 0.8 * t, 1e-9) << start;
    }
    for (const double t : {6.0, 6.2, 6.4}) {
      EXPECT_NEAR(pace.At(start + t).speed, 0.0, 1e-12) << start;
      EXPECT_NEAR(pace.At(start + t).s, pace.At(start + 6.0).s, 1e-9) << start;
    }
  }
}

TEST(Pace, ReversingComesBack) {
  const Pace pace = ReversingPace(1.0, 10.0, 0.5);  // changes take 9 s
  for (const double start : {-20.0, 0.0, 1000.0}) {
    EXPECT_NEAR(pace.At(start + 0.5).speed, 1.0, 1e-12);
    EXPECT_NEAR(pace.At(start + 10.5).speed, -1.0, 1e-12);
    EXPECT_NEAR(pace.At(start + 0.5).s, 0.5, 1e-12);
  }
}

TEST(Pace, NeverEndsToChange) {
  const Pace slow = StopAndGoPace(0.1, 8.0, 5.0, 0.5), back = ReversingPace(3.0, 30.0, 2.0);
  for (const Pace* pace : {&slow, &back}) {
    for (const double from : {-20000.0, -60.0, 705.0, 20000.0}) {
      double least = 1e9, greatest = -1e9;
      for (double t = from; t < from + 60.0; t += 0.01) {
        const double speed = pace->At(t).speed;
        least = std::min(least, speed);
        greatest = std::max(greatest, speed);
      }
      EXPECT_NEAR(least, pace->LeastSpeed(), 1e-12) << from;
      EXPECT_NEAR(greatest, pace->GreatestSpeed(), 1e-12) << from;
    }
  }
}

TEST(Pace, RefusesWhatIsNone) {
  EXPECT_THROW(Pace({{0.0, 0.0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(Pace({{0.0, 0.0}, {0.0, 1.0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(Pace({{0.0, 0.0}, {1.0, 1.0}}, 0.0), std::invalid_argument);
  EXPECT_THROW(Pace::Periodic({{0.0, 0.0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(Pace::Periodic({{0.0, 0.0}, {1.4, 1.0}}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
