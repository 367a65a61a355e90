// SPDX-License-Identifier: BSD-3-Clause
// The duration guess: reachable within the limits in most cases, bounded below by physics, infinite
// for a pad that moves away. For a turning pad it remains a guess. A few steps towards the fixed
// point leave it up to a seventh below the straight line at top speed (the worst of 2000 draws).

#include "planning/problem/duration_guess.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/test/planning_fixtures.h"
#include "touchdown/planning/spline/boundary_lift.h"

namespace touchdown::planning {
namespace {

TEST(DurationGuess, IsNeverBelowTheStraightLineAtTopSpeed) {
  Draw draw(51);
  const Limits limits;
  const EndpointTarget target{0.0, 1.5, 0.0, 1.5};
  for (int trial = 0; trial < 200; ++trial) {
    const ArcPad pad = draw.Pad();
    const SplineState start = draw.State(8.0, 1.5, 0.0);
    const double T = GuessDuration(start, 0.0, pad, target, limits, 1.0);
    if (!std::isfinite(T)) continue;
    const double way = (EndStateAt(pad, target, T).state.p - start.p).norm();
    const bool turns = pad.At(0.0).yaw_rate != 0.0;
    EXPECT_GE(T * limits.speed, (turns ? 0.8 : 1.0) * way) << trial;
  }
}

TEST(DurationGuess, GrowsWithTheDetour) {
  const ArcPad pad({8, 0, 0.3}, 0.5, 0.0, 0.0);
  const SplineState start;
  const EndpointTarget target{0.0, 1.5, 0.0, 1.5};
  EXPECT_GT(GuessDuration(start, 0, pad, target, {}, 1.5),
            GuessDuration(start, 0, pad, target, {}, 1));
}

TEST(DurationGuess, APadThatRunsAwayIsUnreachable) {
  const ArcPad pad({8, 0, 0.3}, 4.0, 0.0, 0.0);
  EXPECT_TRUE(std::isinf(GuessDuration({}, 0.0, pad, {0.0, 1.5, 0.0, 1.5}, {3.0, 6.0}, 1.0)));
}

TEST(DurationGuess, APadAtNineTenthsOfTheSpeedLimitCanBeCaught) {
  const Limits limits{1.0, 6.0};
  const EndpointTarget target{0.0, 1.5, 0.0, 1.5};
  for (const double speed : {0.8, 0.9}) {
    const ArcPad fleeing({3, 0, 0.3}, speed, 0.0, 0.0), crossing({3, 0, 0.3}, speed, 1.5, 0.0);
    EXPECT_TRUE(std::isfinite(GuessDuration({}, 0.0, fleeing, target, limits, 1.0)));
    EXPECT_TRUE(std::isfinite(GuessDuration({}, 0.0, crossing, target, limits, 1.0)));
    const SplineState there = EndStateAt(fleeing, target, 0.0).state;
    EXPECT_LT(GuessDuration(there, 0.0, fleeing, target, limits, 1.0), 0.8);
  }
}

TEST(DurationGuess, IsSmallForAVehicleThatIsThereAlready) {
  const ArcPad pad({8, 0, 0.3}, 0.8, 0.3, 0.1);
  const EndpointTarget target{0.0, 1.5, 0.0, 1.5};
  const SplineState there = EndStateAt(pad, target, 0.0).state;
  EXPECT_LT(GuessDuration(there, 0.0, pad, target, {}, 1.0), 0.3);
}

}  // namespace
}  // namespace touchdown::planning
