// SPDX-License-Identifier: BSD-3-Clause
// Ways around the first obstacle: both sides are tried, the cheaper is flown, and a side once flown
// is kept. Nothing here allocates.

#include <gtest/gtest.h>

#include "planning/replan/prepared_problems.h"
#include "planning/test/replanner_fixtures.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

ReplannerOptions WithGuides(int guides) {
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.max_guides = guides;
  return options;
}

/// Where the curve passes x = 0.
double SideOf(const UniformBspline& curve) {
  for (double t = curve.t0(); t < curve.t_end(); t += 0.01) {
    const Eigen::Vector3d p = curve.Evaluate(t).p_WB;
    if (p.x() >= 0.0) return p.y();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(ReplannerGuides, BothSidesOfAnObstacleAreTriedAndTheCheaperWins) {
  Draw draw(41);
  int chosen_second = 0;
  for (int trial = 0; trial < 30; ++trial) {
    OccupancyMap map = ObservedMap();
    const double y = draw.Uniform(-0.3, 0.3);
    for (double dy = -0.4; dy <= 0.4; dy += 0.4) AddPillar({0.0, y + dy}, &map);
    // Others stand beside the ways around these.
    for (int i = 0; i < 6; ++i) AddPillar({draw.Uniform(-2, 2), draw.Uniform(-3, 3)}, &map);
    const ArcPad pad{{4.0, draw.Uniform(-0.5, 0.5), 0.3}, 0.3, draw.Uniform(-3, 3), 0.0};
    const Eigen::Vector3d start(-4.0, 0.0, 1.6);
    // The shortest way around is not always the cheapest for a vehicle that drifts sideways.
    const Eigen::Vector3d drift(1.0, draw.Uniform(-1.5, 1.5), 0.0);
    double cost[2], side[2], duration[2];
    for (const int guides : {1, 2}) {
      Replanner replanner(WithGuides(guides), solvers::StandardBackends());
      FlyAlong(start, drift, &replanner);
      ReplanInput input = Input(start, pad, 0.0);
      input.vehicle.v_WB = drift;
      const ReplanResult& result = replanner.Replan(input, map);
      ASSERT_EQ(result.status, ReplanStatus::kPlanned);
      duration[guides - 1] = result.curve.duration();
      side[guides - 1] = SideOf(result.curve) - y;
      cost[guides - 1] = result.solver.cost;
      for (const solvers::TermCost& term : result.solver.cost_by_term) {
        // Without the terms whose weights grow from solve to solve.
        const TermRegistry terms = StandardTerms();
        const TermEntry& entry = FindTerm(terms, term.name);
        if (entry.is_clearance || entry.is_limit) cost[guides - 1] -= term.cost;
      }
    }
    chosen_second += side[0] * side[1] < 0.0;
    // A second way may also have avoided a later arrival.
    EXPECT_LE(duration[1], duration[0]);
    if (duration[0] == duration[1]) {
      EXPECT_LE(cost[1], cost[0]);
    }
  }
  EXPECT_GT(chosen_second, 0);
}

TEST(ReplannerGuides, ASideOnceFlownIsKept) {
  // The pad weaves, so that now this side, now that one, is a little cheaper.
  OccupancyMap map = ObservedMap();
  for (double dy = -0.4; dy <= 0.4; dy += 0.4) AddPillar({0.0, dy}, &map);
  Replanner replanner(WithGuides(2), solvers::StandardBackends());
  Eigen::Vector3d p(-5.0, 0.0, 1.6);
  replanner.CommitHover(p, 0.0);
  double first_side = 0.0;
  for (int step = 0; p.x() < -0.6; ++step) {
    ASSERT_LT(step, 100);
    const double t = 0.1 * step;
    const ArcPad pad({5.0, step % 2 == 0 ? 0.15 : -0.15, 0.3}, 0.0, 0.0, 0.0);
    ReplanInput input = Input(p, pad, t);
    input.vehicle.v_WB = replanner.Reference(t).v_WB;
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned) << t;
    const double side = SideOf(result.curve);
    if (step == 0) first_side = side;
    EXPECT_GT(side * first_side, 0.0) << t;
    p = replanner.Reference(t + 0.1).p_WB;
  }
}

// Between two looks for other ways a plan that holds costs one solve and no search. A replanner with the same memory
// makes the same step.
TEST(ReplannerGuides, APlanThatHoldsCostsOneSolve) {
  Draw draw(43);
  int steps = 0, solves = 0, looks = 0;
  for (int trial = 0; trial < 10; ++trial) {
    OccupancyMap map = ObservedMap();
    for (double dy = -0.4; dy <= 0.4; dy += 0.4) {
      AddPillar({0.0, draw.Uniform(-0.3, 0.3) + dy}, &map);
    }
    const ArcPad pad{{4.0, draw.Uniform(-0.5, 0.5), 0.3}, 0.3, draw.Uniform(-3, 3), 0.0};
    ReplannerOptions options = WithGuides(2);
    options.arrival = ArrivalMode::kFree;
    Replanner replanner(options, solvers::StandardBackends());
    Replanner other(options, solvers::StandardBackends());
    FlyAlong({-4.0, 0.0, 1.6}, {1.0, 0.0, 0.0}, &replanner);
    for (double t = 0.0; t < 1.45; t += 0.1) {
      ReplanInput input = Input(replanner.Reference(t).p_WB, pad, t);
      input.vehicle.v_WB = replanner.Reference(t).v_WB;
      const ReplannerState memory = replanner.state();
      const ReplanResult& result = replanner.Replan(input, map);
      ASSERT_EQ(result.status, ReplanStatus::kPlanned) << t;
      other.Restore(memory);
      const ReplanResult& again = other.Replan(input, map);
      ASSERT_EQ(again.curve.control_points(), result.curve.control_points()) << t;
      if (replanner.state().looked_t == input.t_start) {
        ++looks;
        continue;
      }
      ++steps;
      solves += result.solves;
      EXPECT_TRUE(result.guide_paths.empty()) << t;
    }
  }
  EXPECT_EQ(looks, 30);
  EXPECT_EQ(steps, 120);
  EXPECT_LE(solves, 140);
}

// The end of a wall comes into sight bit by bit. What is flown moves with it, without a search for another
// way and without trying another arrival.
TEST(ReplannerGuides, AWallThatTurnsOutLongerMovesTheWay) {
  OccupancyMap map = ObservedMap();
  const auto add_wall = [&](double from, double to) {
    for (double y = from; y < to; y += 0.1) {
      for (double z = 0.05; z < 3.1; z += 0.1) map.SetOccupied({0.05, y, z});
    }
  };
  add_wall(-3.0, 0.35);
  const ArcPad pad({4.0, 0.0, 0.3}, 0.3, 0.0, 0.0);
  Replanner replanner(WithGuides(1), solvers::StandardBackends());
  const Eigen::Vector3d start(-4.0, 0.0, 1.6);
  FlyAlong(start, {1.5, 0.0, 0.0}, &replanner);
  ReplanLog log;
  replanner.set_log(&log);
  double t = 0.0;
  for (int step = 0; step < 8; ++step, t += 0.1) {
    if (step > 0) add_wall(0.35 + 0.12 * (step - 1), 0.35 + 0.12 * step);
    ReplanInput input = Input(replanner.Reference(t).p_WB, pad, t);
    input.vehicle.v_WB = replanner.Reference(t).v_WB;
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned) << step;
    EXPECT_GT(SideOf(result.curve), 0.35 + 0.12 * step) << step;
    if (step == 0) continue;
    EXPECT_EQ(log.attempts.size(), 1u) << step;
    EXPECT_TRUE(result.guide_paths.empty()) << step;
  }
}

// If the arrival is too early for the way around, later ones are tried: plans are slower, not longer.
TEST(ReplannerGuides, AnAttemptThatFailsIsFollowedByASlowerOne) {
  Draw draw(17);
  int followed = 0, held_back = 0, planned = 0;
  for (int trial = 0; trial < 40; ++trial) {
    OccupancyMap map = ObservedMap();
    for (int i = 0; i < 34; ++i) AddPillar({draw.Uniform(-3, 3), draw.Uniform(-2, 2)}, &map);
    const ArcPad pad{{5.0, draw.Uniform(-1, 1), 0.3}, 0.3, draw.Uniform(-3, 3), 0.0};
    Replanner replanner(WithGuides(1), solvers::StandardBackends());
    ReplanLog log;
    replanner.set_log(&log);
    const Eigen::Vector3d start(-5.0, 0.0, 1.6), v_WB(1.5, 0.0, 0.0);
    FlyAlong(start, v_WB, &replanner);
    ReplanInput input = Input(start, pad, 0.0);
    input.vehicle.v_WB = v_WB;
    const ReplanStatus status = replanner.Replan(input, map).status;
    if (log.attempts.size() < 2 || log.attempts[0].rounds.size() < 2) continue;
    const Limits& limits = replanner.options().limits;
    const UniformBspline& before = log.attempts[0].rounds.front().curve;
    EXPECT_EQ(before.segments(),
              SegmentsFor(before.duration(), limits, 1.0, ReplannerOptions().segment_length))
        << trial;
    for (std::size_t i = 1; i < log.attempts.size(); ++i) {
      const AttemptLog& attempt = log.attempts[i];
      if (attempt.rounds.empty()) continue;  // the pad is blocked then
      ++followed;
      EXPECT_GE(attempt.duration, 1.4 * log.attempts[i - 1].duration) << trial;
      EXPECT_TRUE(attempt.rounds.front().pairs.empty()) << "everything is decided anew, " << trial;
      const UniformBspline& curve = attempt.rounds.front().curve;
      const double counted = std::min(curve.duration(), 1.2 * before.duration());
      EXPECT_EQ(curve.segments(), SegmentsFor(counted, limits, StepConstants().fine_segments,
                                              ReplannerOptions().segment_length))
          << trial;
      held_back +=
          curve.segments() < SegmentsFor(curve.duration(), limits, StepConstants().fine_segments,
                                         ReplannerOptions().segment_length);
    }
    planned += status == ReplanStatus::kPlanned;
  }
  EXPECT_GT(followed, 3);
  EXPECT_GT(held_back, 0);
  EXPECT_GT(planned, 3);
}

// Coarse segments leave the first half second to the start; an obstacle there is passed with fine ones. Only
// a fixed arrival's curve is solved for once more on these before it is led around.
TEST(ReplannerGuides, ANearObstacleGetsFineSegmentsAtOnce) {
  struct Case {
    bool near;
    ArrivalMode arrival;
    bool solves_fine;
  };
  const ArcPad pad({5.0, 0.0, 0.3}, 0.3, 0.0, 0.0);
  const Eigen::Vector3d start(-5.0, 0.0, 1.6), v_WB(1.2, 0.0, 0.0);
  for (const Case& c :
       {Case{true, ArrivalMode::kFixed, true}, Case{true, ArrivalMode::kFree, false},
        Case{false, ArrivalMode::kFixed, false}, Case{false, ArrivalMode::kFree, false}}) {
    OccupancyMap map = ObservedMap();
    AddPillar({c.near ? -4.0 : 0.0, 0.05}, &map);
    ReplannerOptions options = Options(c.arrival);
    // With its real hull the vehicle is too near to the pillar to stop, so no plan would be proven.
    // Only the segments matter here.
    options.hull_radius = 0.0;
    options.limits.body_rate = 100.0;
    Replanner replanner(options, solvers::StandardBackends());
    ReplanLog log;
    replanner.set_log(&log);
    FlyAlong(start, v_WB, &replanner);
    ReplanInput input = Input(start, pad, 0.0);
    input.vehicle.v_WB = v_WB;
    EXPECT_EQ(replanner.Replan(input, map).status, ReplanStatus::kPlanned);
    ASSERT_FALSE(log.attempts.empty());
    const AttemptLog& first = log.attempts.front();
    const bool fine = first.rounds.back().curve.segments() > first.rounds.front().curve.segments();
    EXPECT_EQ(fine, c.near);
    EXPECT_EQ(first.segments, first.rounds.back().curve.segments());
    EXPECT_TRUE(first.rounds[0].pairs.empty());
    EXPECT_EQ(first.rounds[1].pairs.empty(), c.solves_fine);
  }
}

TEST(ReplannerGuides, AStepDoesNotAllocateOnceWarm) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  OccupancyMap map = ObservedMap();
  AddPillar({-1.0, 0.2}, &map);
  AddPillar({1.5, -0.3}, &map);
  const ArcPad pad({5.0, 1.0, 0.3}, 0.5, 0.4, 0.1);
  Replanner replanner(WithGuides(2), solvers::StandardBackends());
  // The same flight twice: the first grows the buffers.
  for (const bool counted : {false, true}) {
    Eigen::Vector3d p(-5.0, 0.0, 1.6);
    replanner.CommitHover(p, 0.0);
    for (int step = 0; step < 60; ++step) {
      const double t = 0.1 * step;
      ReplanInput input = Input(p, pad, t);
      input.vehicle.v_WB = replanner.Reference(t).v_WB;
      const long before = solvers::AllocationCount();
      const ReplanResult& result = replanner.Replan(input, map);
      const long after = solvers::AllocationCount();
      if (counted) {
        EXPECT_EQ(after - before, 0) << t << " " << ToString(result.status);
      }
      p = replanner.Reference(t + 0.1).p_WB;
    }
  }
}

}  // namespace
}  // namespace touchdown::planning
