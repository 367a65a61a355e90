// SPDX-License-Identifier: BSD-3-Clause
// The PID baseline as a planner: its flights with a pad that drives straight, at rest, late and lost.
#include "planning/baselines/pid/pid_follower.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 1.0 / PidFollower::kRate;

/// A vehicle that flies its reference with a steady offset, over a pad that drives straight.
class Flight {
 public:
  explicit Flight(double pad_speed, const Vector3d& offset = Vector3d::Zero(), PidGains gains = {})
      : pad(Vector3d(4, 3, 0.5), pad_speed, 0.7, 0.0),
        planner(gains, Limits{}),
        map(OccupancyMapOptions{}),
        offset_(offset) {
    planner.CommitHover(Vector3d(0, 0, 2), 0.0);
  }

  ReplanInput Input() const {
    const FlatState at = planner.Reference(t);
    ReplanInput input;
    input.t_now = t;
    input.t_start = t + 0.01;
    input.vehicle.t = t;
    input.vehicle.p_WB = at.p_WB + offset_;
    input.vehicle.v_WB = at.v_WB;
    input.pad = &pad;
    input.endpoint = {t, 1.5, 0.0, 1.5};
    return input;
  }

  void Follow(double seconds) {
    for (const double end = t + seconds; t < end; t += kPeriod) {
      status = planner.Replan(Input(), map).status;
      const FlatState at = planner.Reference(t);
      speed = std::max(speed, at.v_WB.norm());
      acceleration = std::max(acceleration, at.a_WB.norm());
    }
  }

  /// Of the vehicle, from its place above the pad [m].
  Vector3d Error() const {
    return planner.Reference(t).p_WB + offset_ - pad.At(t).p_WP - Vector3d(0, 0, 1.5);
  }

  ArcPad pad;
  PidFollower planner;
  OccupancyMap map;
  double t = 0.0, speed = 0.0, acceleration = 0.0;
  ReplanStatus status = ReplanStatus::kHolding;

 private:
  Vector3d offset_;
};

TEST(PidFollower, LeavesNoSteadyErrorOverAPadOfConstantVelocity) {
  for (const double pad_speed : {0.0, 0.8, 2.0}) {
    Flight flight(pad_speed);
    flight.Follow(40.0);
    EXPECT_LT(flight.Error().norm(), 1e-3) << pad_speed;
    EXPECT_EQ(flight.status, ReplanStatus::kPlanned);
    const Vector3d v = flight.planner.Reference(flight.t).v_WB;
    EXPECT_LT((v - flight.pad.At(flight.t).v_WP).norm(), 1e-3);
    EXPECT_LE(flight.speed, Limits{}.speed + 1e-9);
    EXPECT_LE(flight.acceleration, Limits{}.acceleration + 1e-9);
  }
}

TEST(PidFollower, TakesUpASteadyHorizontalOffsetOfTheVehicle) {
  Flight flight(0.8, Vector3d(-0.2, 0.1, 0.0));
  flight.Follow(60.0);
  EXPECT_LT(flight.Error().norm(), 1e-3);
}

TEST(PidFollower, TheHeightSinksAsItIsAskedTo) {
  Flight flight(0.5);
  flight.Follow(20.0);
  ReplanInput input = flight.Input();
  for (int k = 0; k < 200; ++k, flight.t += kPeriod) {
    input = flight.Input();
    input.endpoint = {20.0, 1.5, 0.3, 0.2};
    flight.planner.Replan(input, flight.map);
  }
  const FlatState at = flight.planner.Reference(flight.t);
  EXPECT_NEAR(at.v_WB.z(), -0.3, 5e-3);
  EXPECT_NEAR(at.p_WB.z(), 0.5 + 1.5 - 0.3 * (flight.t - 20.0), 5e-3);
}

TEST(PidFollower, AReferenceIsContinuous) {
  Flight flight(0.8);
  double jump = 0.0, jolt = 0.0;
  for (int k = 0; k < 300; ++k, flight.t += kPeriod) {
    const ReplanInput input = flight.Input();
    const FlatState before = flight.planner.Reference(input.t_start);
    const ReplanResult& result = flight.planner.Replan(input, flight.map);
    const FlatState after = flight.planner.Reference(input.t_start);
    EXPECT_EQ(result.curve.t0(), input.t_start);
    jump = std::max(jump, (after.p_WB - before.p_WB).norm());
    jolt = std::max(jolt, (after.v_WB - before.v_WB).norm());
  }
  EXPECT_LT(jump, 1e-12);
  EXPECT_LT(jolt, 1e-12);
}

TEST(PidFollower, BrakesAndClimbsToRest) {
  Flight flight(0.8);
  flight.Follow(2.0);
  const double low = flight.planner.Reference(flight.t).p_WB.z();
  EXPECT_EQ(flight.planner.Rest(flight.Input(), 1.0, flight.map).status, ReplanStatus::kClimbing);
  ReplanStatus last = ReplanStatus::kClimbing;
  for (int k = 0; k < 600; ++k) {
    flight.t += kPeriod;
    last = flight.planner.Rest(flight.Input(), 1.0, flight.map).status;
  }
  EXPECT_EQ(last, ReplanStatus::kHolding);
  const FlatState at = flight.planner.Reference(flight.t);
  EXPECT_LT(at.v_WB.norm(), 1e-3);
  EXPECT_NEAR(at.p_WB.z(), low + 1.0, 0.05);
  flight.Follow(2.0);
  EXPECT_EQ(flight.planner.Rest(flight.Input(), 0.0, flight.map).status, ReplanStatus::kBraking);
}

TEST(PidFollower, AStepBeforeTheLastTookOverIsIdleAndALateOneTakesOverLate) {
  Flight flight(0.8);
  flight.Follow(1.0);
  const ReplanInput input = flight.Input();
  const FlatState before = flight.planner.Reference(input.t_start + 0.03);
  EXPECT_FALSE(flight.planner.Replan(input, flight.map).idle);
  flight.planner.TakeOverAt(input.t_start + 0.05);
  EXPECT_EQ(flight.planner.Reference(input.t_start + 0.03).p_WB, before.p_WB);
  flight.t = input.t_start + 0.02;
  EXPECT_TRUE(flight.planner.Replan(flight.Input(), flight.map).idle);
  flight.t = input.t_start + 0.05;
  EXPECT_FALSE(flight.planner.Replan(flight.Input(), flight.map).idle);
}

TEST(PidFollower, StartsAtTheVehicleWhereTheReferenceLostIt) {
  Flight flight(0.8);
  ReplanInput input = flight.Input();
  input.vehicle.p_WB.y() += 0.6;
  const ReplanResult& result = flight.planner.Replan(input, flight.map);
  EXPECT_TRUE(result.from_odometry);
  const Vector3d p = flight.planner.Reference(input.t_start).p_WB;
  EXPECT_LT((p - input.vehicle.p_WB).norm(), 1e-12);
}

TEST(PidFollower, RefusesWhatIsNoNumberAndGoesOn) {
  Flight flight(0.8);
  flight.Follow(1.0);
  const Vector3d p = flight.planner.Reference(flight.t + 0.1).p_WB;
  ReplanInput input = flight.Input();
  input.vehicle.p_WB.x() = std::numeric_limits<double>::quiet_NaN();
  const ReplanResult& result = flight.planner.Replan(input, flight.map);
  EXPECT_EQ(result.reason, ReplanReason::kInvalidInput);
  EXPECT_EQ(result.status, ReplanStatus::kKept);
  EXPECT_EQ(flight.planner.Reference(flight.t + 0.1).p_WB, p);
  EXPECT_THROW(PidFollower(PidGains{}, Limits{0.0, 6.0}), std::invalid_argument);
}

TEST(PidFollower, AllocatesNothingInItsSteps) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  Flight flight(0.8);
  const long before = solvers::AllocationCount();
  flight.Follow(3.0);
  flight.planner.Rest(flight.Input(), 1.0, flight.map);
  EXPECT_EQ(solvers::AllocationCount() - before, 0);
}

}  // namespace
}  // namespace touchdown::planning
