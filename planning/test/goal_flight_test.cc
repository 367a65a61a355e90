// SPDX-License-Identifier: BSD-3-Clause
// Goals at all heights, that stand or move, behind pillars and doors, asked for at all rates. They
// are reached, and the vehicle touches nothing on the way.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/replan/goal.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::planning {
namespace {

constexpr double kFloor = 0.45;  // ReplannerOptions::floor_height
constexpr double kHull = 0.324;  // ReplannerOptions::hull_radius

/// Pillars, and in every other world a wall with a door.
struct GoalWorld {
  explicit GoalWorld(std::uint64_t seed) : map(MapOptions()) {
    map.Recentre({0.0, 0.0, 2.8});
    Draw draw(seed);
    start = {draw.Uniform(-6.0, -4.0), draw.Uniform(-3.0, 3.0), draw.Uniform(0.6, 3.5)};
    goal = {draw.Uniform(3.0, 6.0), draw.Uniform(-3.0, 3.0), draw.Uniform(0.5, 4.5)};
    velocity = {draw.Uniform(-0.3, 0.6), draw.Uniform(-0.5, 0.5), draw.Uniform(-0.05, 0.05)};
    moves = seed % 3 == 0;
    const double periods[] = {0.05, 0.1, 0.2, 0.3, 0.6, 1.0};
    period = periods[static_cast<int>(draw.Uniform(0.0, 6.0))];
    speed = draw.Uniform(1.5, 5.0);
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d at{draw.Uniform(-3.0, 2.0), draw.Uniform(-4.0, 4.0), 0.0};
      const double top = draw.Uniform(1.0, 5.0);
      Fill(at - Eigen::Vector3d(0.2, 0.2, 0.0), at + Eigen::Vector3d(0.2, 0.2, top));
    }
    if (seed % 2 == 0) {
      const double door = draw.Uniform(-2.0, 2.0);
      Fill({0.0, -8.0, 0.0}, {0.2, door - 0.8, 6.0});
      Fill({0.0, door + 0.8, 0.0}, {0.2, 8.0, 6.0});
    }
    map.MarkRestFree();
  }

  static OccupancyMapOptions MapOptions() {
    OccupancyMapOptions options;
    options.inflation_radius = 0.4;
    return options;
  }
  /// Except the room around the start and the goal, and all of the goal's way.
  void Fill(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    for (double x = low.x() + 0.05; x < high.x(); x += 0.1) {
      for (double y = low.y() + 0.05; y < high.y(); y += 0.1) {
        const Eigen::Vector2d at(x, y);
        if ((at - start.head<2>()).norm() < 1.0 || (at - goal.head<2>()).norm() < 1.0) continue;
        if (moves && x > 0.3) continue;
        for (double z = low.z() + 0.05; z < high.z(); z += 0.1) map.SetOccupied({x, y, z});
      }
    }
  }

  OccupancyMap map;
  Eigen::Vector3d start, goal, velocity;
  bool moves;
  double period, speed;
};

/// From the body's origin to the nearest occupied cell; infinite beyond a metre.
double ClearanceAt(const OccupancyMap& map, const Eigen::Vector3d& p_W) {
  double least = std::numeric_limits<double>::infinity();
  const CellIndex low = map.CellOf(p_W.array() - 1.0), high = map.CellOf(p_W.array() + 1.0);
  ForEachCell({low, high}, [&](const CellIndex& cell) {
    if (!map.InWindow(cell) || !map.IsOccupied(cell)) return;
    const Eigen::Array3d off = (map.CentreOf(cell) - p_W).array().abs() - 0.5 * map.resolution();
    least = std::min(least, off.max(0.0).matrix().norm());
  });
  return least;
}

struct Flown {
  bool there = false;
  double t = 0.0;
  double clearance = std::numeric_limits<double>::infinity();
  double lowest = std::numeric_limits<double>::infinity();
  std::string reason;
};

Flown Fly(const GoalWorld& world) {
  std::unique_ptr<estimation::PadPrediction> goal = std::make_unique<GoalAt>(world.goal);
  if (world.moves) {
    goal = std::make_unique<MovingGoal>([&world](const Taylor& t) {
      // It comes to rest beside where it was, so that it stays in the world.
      const Taylor way = 1.0 - exp(-0.2 * t);
      MovingGoal::Position p;
      for (int i = 0; i < 3; ++i) p[i] = world.goal[i] + 5.0 * world.velocity[i] * way;
      return p;
    });
  }
  ReplannerOptions options;
  options.limits.speed = world.speed;
  Replanner replanner(options, solvers::StandardBackends());
  replanner.CommitHover(world.start, 0.0);
  Flown flown;
  for (double t = 0.0; t < 60.0; t += world.period) {
    ReplanInput input;
    const FlatState now = replanner.Reference(t);
    input.t_now = t;
    input.t_start = t + 0.02;
    input.vehicle.p_WB = now.p_WB;
    input.vehicle.v_WB = now.v_WB;
    input.pad = goal.get();
    input.endpoint.height = 0.0;
    const ReplanResult& plan = replanner.Replan(input, world.map);
    EXPECT_TRUE(plan.proven);
    flown.reason = Explain(plan.reason);
    for (double after = t; after < t + world.period; after += 0.02) {
      const FlatState at = replanner.Reference(after);
      flown.clearance = std::min(flown.clearance, ClearanceAt(world.map, at.p_WB));
      flown.lowest = std::min(flown.lowest, at.p_WB.z());
      const estimation::PadState wanted = goal->At(after);
      flown.there = (at.p_WB - wanted.p_WP).norm() < 0.05 && (at.v_WB - wanted.v_WP).norm() < 0.05;
      flown.t = after;
      if (flown.there) return flown;
    }
  }
  return flown;
}

TEST(GoalFlight, ReachesGoalsAtAllHeightsAndRates) {
  for (std::uint64_t seed = 1; seed <= 18; ++seed) {
    const GoalWorld world(seed);
    const Flown flown = Fly(world);
    EXPECT_TRUE(flown.there) << "seed " << seed << ", period " << world.period << ", from "
                             << world.start.transpose() << " to " << world.goal.transpose() << ": "
                             << flown.reason;
    EXPECT_GT(flown.clearance, kHull) << seed;
    EXPECT_GT(flown.lowest, kFloor - 1e-6) << seed;
  }
}

TEST(GoalFlight, SaysThatAGoalBelowTheFloorIsBlocked) {
  const GoalWorld world(1);
  const GoalAt low({4.0, 0.0, 0.2});
  Replanner replanner(ReplannerOptions{}, solvers::StandardBackends());
  replanner.CommitHover(world.start, 0.0);
  ReplanInput input;
  input.t_start = 0.02;
  input.vehicle.p_WB = world.start;
  input.pad = &low;
  input.endpoint.height = 0.0;
  EXPECT_EQ(replanner.Replan(input, world.map).reason, ReplanReason::kGoalBlocked);
}

}  // namespace
}  // namespace touchdown::planning
