// SPDX-License-Identifier: BSD-3-Clause
// The baseline's state machine in flights that track perfectly.
#include "planning/baselines/ego/ego_planner.h"

#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

/// A vehicle that flies its reference exactly, in an observed map.
class Flight {
 public:
  explicit Flight(const EgoPlannerOptions& options) : planner(options), map(OccupancyMapOptions{}) {
    planner.CommitHover(kStart, 0.0);
    map.Recentre(kStart);
  }

  /// Flies for `seconds` after a pad that drives straight; averages over the last second.
  void Follow(const Vector3d& pad_start, double pad_speed, double seconds) {
    error = relative_speed = 0.0;
    const ArcPad pad(pad_start, pad_speed, 0.0, 0.0);
    const int steps = static_cast<int>(seconds * EgoPlanner::kRate);
    const int last = static_cast<int>(EgoPlanner::kRate);
    for (int k = 0; k < steps; ++k, t += 1.0 / EgoPlanner::kRate) {
      const FlatState at = planner.Reference(t);
      map.Recentre(at.p_WB);
      ReplanInput input;
      input.t_now = t;
      input.t_start = t + 0.002;
      input.vehicle.t = t;
      input.vehicle.p_WB = at.p_WB;
      input.vehicle.v_WB = at.v_WB;
      input.pad = &pad;
      input.endpoint = {t, 1.0, 0.0, 1.0};
      result = planner.Replan(input, map);
      if (!result.detail.empty()) call = result;
      if (modes.empty() || modes.back() != planner.mode()) modes.push_back(planner.mode());
      if (result.status == ReplanStatus::kPlanned) ++plans;
      if (result.detail == "emergency_stop") ++stops;
      if (steps - k > last) continue;
      const estimation::PadState now = pad.At(t);
      error += (at.p_WB - now.p_WP - Vector3d::UnitZ()).norm() / last;
      relative_speed += (at.v_WB - now.v_WP).norm() / last;
    }
  }

  static inline const Vector3d kStart{0, 0, 2};
  EgoPlanner planner;
  OccupancyMap map;
  ReplanResult result;  // of the last step
  ReplanResult call;    // of the last step with a plan call
  double t = 0.0;
  std::vector<EgoMode> modes;  // one after the other
  int plans = 0;
  int stops = 0;
  double error = 0.0;           // [m]
  double relative_speed = 0.0;  // [m/s]
};

EgoPlannerOptions AtRate(double goal_rate, bool velocity = false) {
  EgoPlannerOptions options;
  options.goal_rate = goal_rate;
  options.goal_velocity = velocity;
  return options;
}

/// Behind a target on a straight line; errors [m] and relative speeds [m/s] of the released program.
struct Trail {
  double max_speed, max_acceleration, target_speed, goal_rate, error, relative_speed;
};

TEST(EgoPlanner, TrailsAMovingGoalAsMeasured) {
  for (const Trail& trail :
       {Trail{2.0, 3.0, 1.0, 1.0, 1.06, 0.45}, Trail{2.0, 3.0, 1.0, 2.0, 0.58, 0.22},
        Trail{2.0, 3.0, 1.0, 10.0, 0.24, 0.05}, Trail{3.0, 6.0, 1.5, 2.0, 0.81, 0.43},
        Trail{3.0, 6.0, 1.5, 5.0, 0.46, 0.14}, Trail{3.0, 6.0, 1.5, 10.0, 0.37, 0.05}}) {
    EgoPlannerOptions options = AtRate(trail.goal_rate);
    options.plan.max_speed = trail.max_speed;
    options.plan.max_acceleration = trail.max_acceleration;
    Flight flight(options);
    flight.Follow({8, 0, 1}, trail.target_speed, 20.0);
    EXPECT_NEAR(flight.error, trail.error, 0.03) << trail.target_speed << " " << trail.goal_rate;
    EXPECT_NEAR(flight.relative_speed, trail.relative_speed, 0.03)
        << trail.target_speed << " " << trail.goal_rate;
  }
}

TEST(EgoPlanner, RefusesOptionsOutOfRange) {
  EXPECT_THROW(EgoPlanner{AtRate(0.0)}, std::invalid_argument);
  EgoPlannerOptions options;
  options.plan.horizon = -1.0;
  EXPECT_THROW(EgoPlanner{options}, std::invalid_argument);
}

TEST(EgoPlanner, ReachesAGoalAtRestAndWaits) {
  Flight flight(AtRate(0.1));
  flight.Follow({5, 1, 1}, 0.0, 9.0);
  // Replans once it is under way, and no more near the goal.
  const std::vector<EgoMode> modes = {EgoMode::kExecute, EgoMode::kReplan,  EgoMode::kExecute,
                                      EgoMode::kReplan,  EgoMode::kExecute, EgoMode::kWaitTarget};
  EXPECT_EQ(flight.modes, modes);
  EXPECT_EQ(flight.plans, 3);
  EXPECT_LT(flight.error, 0.1);
  EXPECT_LT(flight.relative_speed, 0.01);
  EXPECT_EQ(flight.planner.mode(), EgoMode::kWaitTarget);
}

TEST(EgoPlanner, AGoalTooNearIsNamedAndTriedAgain) {
  Flight flight(AtRate(5.0));
  flight.Follow({0.1, 0, 1}, 0.0, 0.5);
  EXPECT_EQ(flight.planner.mode(), EgoMode::kGenerate);
  EXPECT_EQ(flight.call.detail, "close_to_goal");
  EXPECT_EQ(flight.call.reason, ReplanReason::kAtGoal);
  EXPECT_EQ(flight.plans, 0);
}

TEST(EgoPlanner, AGoalInAWallIsNamed) {
  Flight flight(AtRate(0.1));
  for (double x = 2.0; x < 8.0; x += 0.1) {
    for (double y = -3.0; y < 3.0; y += 0.1) {
      for (double z = 0.05; z < 5.0; z += 0.1) flight.map.SetOccupied({x, y, z});
    }
  }
  flight.Follow({5, 0, 1}, 0.0, 1.0);
  EXPECT_TRUE(flight.call.reason == ReplanReason::kGoalBlocked ||
              flight.call.reason == ReplanReason::kCollisionRemains)
      << flight.call.detail;
  EXPECT_EQ(flight.planner.mode(), EgoMode::kGenerate);
}

TEST(EgoPlanner, StopsWhereItIsBeforeAWallThatAppears) {
  Flight flight(AtRate(0.1));
  flight.Follow({7, 0, 1}, 0.0, 2.5);
  ASSERT_EQ(flight.planner.mode(), EgoMode::kExecute);
  const double wall = flight.planner.Reference(flight.t).p_WB.x() + 1.0;
  for (double y = -8.0; y < 8.0; y += 0.1) {
    for (double z = 0.05; z < 5.0; z += 0.1) {
      for (double x = wall; x < wall + 0.3; x += 0.1) flight.map.SetOccupied({x, y, z});
    }
  }
  flight.Follow({7, 0, 1}, 0.0, 0.1);
  EXPECT_EQ(flight.stops, 1);
  const FlatState stopped = flight.planner.Reference(flight.t);
  EXPECT_TRUE(stopped.v_WB.isZero());
  EXPECT_LT(stopped.p_WB.x(), wall);
}

TEST(EgoPlanner, AStopEndsWhenTheVehicleStandsAndTheSecondIsNotArmed) {
  Flight flight(AtRate(0.1));
  const auto wall = [&](double ahead) {
    const double x0 = flight.planner.Reference(flight.t).p_WB.x() + ahead;
    for (double y = -8.0; y < 8.0; y += 0.1) {
      for (double z = 0.05; z < 5.0; z += 0.1) {
        for (double x = x0; x < x0 + 0.3; x += 0.1) flight.map.SetOccupied({x, y, z});
      }
    }
  };
  flight.Follow({7, 0, 1}, 0.0, 2.5);
  wall(1.0);
  flight.modes.clear();
  flight.Follow({7, 0, 1}, 0.0, 0.5);
  ASSERT_GE(flight.modes.size(), 2u);
  EXPECT_EQ(flight.modes[0], EgoMode::kEmergencyStop);
  EXPECT_EQ(flight.modes[1], EgoMode::kGenerate);
  EXPECT_EQ(flight.stops, 1);
  // Nothing leads through the wall: it stays there and says why, again and again.
  EXPECT_EQ(flight.planner.mode(), EgoMode::kGenerate);
  EXPECT_EQ(flight.call.reason, ReplanReason::kSearchFailed) << flight.call.detail;
}

TEST(EgoPlanner, ANewGoalMakesItReplanAtOnce) {
  Flight flight(AtRate(2.0));
  flight.Follow({9, 0, 1}, 0.5, 2.9);
  EXPECT_GE(flight.plans, 6);
  EXPECT_EQ(flight.planner.mode(), EgoMode::kExecute);
}

TEST(EgoPlanner, RestFliesToTheEndOfTheTrajectoryAndAClimbIsAGoal) {
  Flight flight(AtRate(0.1));
  flight.Follow({5, 0, 1}, 0.0, 2.0);
  ReplanInput input;
  const auto rest = [&](double climb, double seconds) {
    for (const double end = flight.t + seconds; flight.t < end;
         flight.t += 1.0 / EgoPlanner::kRate) {
      const FlatState at = flight.planner.Reference(flight.t);
      input.t_now = flight.t;
      input.t_start = flight.t + 0.002;
      input.vehicle.p_WB = at.p_WB;
      input.vehicle.v_WB = at.v_WB;
      flight.planner.Rest(input, climb, flight.map);
    }
    return flight.planner.Reference(flight.t);
  };
  const FlatState rested = rest(0.0, 8.0);
  EXPECT_TRUE(rested.v_WB.isZero());
  EXPECT_EQ(flight.planner.mode(), EgoMode::kWaitTarget);
  const FlatState climbed = rest(1.5, 6.0);
  EXPECT_NEAR(climbed.p_WB.z() - rested.p_WB.z(), 1.5, 0.1);
  EXPECT_TRUE(climbed.v_WB.isZero());
}

TEST(EgoPlanner, NamesNumbersThatItCannotUse) {
  Flight flight(AtRate(5.0));
  flight.Follow({6, 0, 1}, 0.5, 1.0);
  const auto ask = [&](const ReplanInput& input) -> const ReplanResult& {
    const ReplanResult& result = flight.planner.Replan(input, flight.map);
    EXPECT_EQ(result.reason, ReplanReason::kInvalidInput);
    EXPECT_EQ(result.detail, "invalid_input");
    EXPECT_EQ(result.status, ReplanStatus::kKept);
    return result;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const ArcPad far({5e3, 0, 1}, 0.5, 0.0, 0.0), near({6, 0, 1}, 0.5, 0.0, 0.0);
  ReplanInput input;
  input.t_now = input.t_start = flight.t;
  input.pad = &near;
  input.vehicle.v_WB.x() = kNan;
  ask(input);
  EXPECT_EQ(flight.planner.Rest(input, 0.0, flight.map).reason, ReplanReason::kInvalidInput);
  input.vehicle.v_WB.setZero();
  input.t_start = kNan;
  ask(input);
  input.t_start = flight.t;
  input.pad = &far;
  ask(input);
  EXPECT_TRUE(flight.planner.Reference(flight.t).p_WB.allFinite());
}

TEST(EgoPlanner, TwoFlightsAreTheSame) {
  const auto fly = [] {
    Flight flight(AtRate(5.0, true));
    flight.Follow({6, 2, 1}, 0.7, 6.0);
    return flight.planner.Reference(flight.t).p_WB;
  };
  EXPECT_EQ(fly(), fly());
}

}  // namespace
}  // namespace touchdown::planning
