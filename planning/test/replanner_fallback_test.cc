// SPDX-License-Identifier: BSD-3-Clause
// The ladder below a plan: what is flown when nothing is certified, and when nothing may be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "planning/replan/fallback.h"
#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::planning {
namespace {

TEST(ReplannerFallback, UnobservedSpaceIsEnteredAtACrawlOrNotAtAll) {
  OccupancyMap unobserved{OccupancyMapOptions{}};
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  unobserved.MarkFree(start, 0.3);
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  const ReplanInput input = Input(start, pad, 0.0);
  replanner.Replan(input, unobserved);
  // The flown trajectory can stop within the observed 0.3 m until the next plan.
  const double t = input.t_start + replanner.options().reaction;
  const double speed = replanner.Reference(t).v_WB.norm();
  EXPECT_LE(speed * speed / (2 * 0.6 * 6.0), 0.3);
}

TEST(ReplannerFallback, BrakesBeforeSpaceThatStaysUnobserved) {
  // The camera is dead: the map never grows beyond 4 m around the start.
  OccupancyMap map{OccupancyMapOptions{}};
  const Eigen::Vector3d start(-6.0, 0.0, 1.5);
  map.MarkFree(start, 4.0);
  const ArcPad pad({6.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  bool braked = false;
  for (int step = 0; step < 80; ++step) {
    const double t = 0.1 * step;
    const FlatState at = replanner.Reference(t);
    EXPECT_LE((at.p_WB - start).norm(), 4.0 + 0.1);
    ReplanInput input = Input(at.p_WB, pad, t);
    input.vehicle.v_WB = at.v_WB;
    braked = replanner.Replan(input, map).status == ReplanStatus::kBraking || braked;
  }
  EXPECT_TRUE(braked);
}

// Without a plan to where it looks from, a proven straight move leads there.
TEST(ReplannerFallback, GoesStraightToWhereItLooksFrom) {
  OccupancyMap map{OccupancyMapOptions{}};
  const Eigen::Vector3d start(-4.0, 0.0, 1.5), there = start + Eigen::Vector3d(-0.2, 0.25, 0.1);
  const double radius = 0.8;
  map.MarkFree(start, radius);
  const ArcPad pad({5.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.max_work = 1;
  Replanner replanner(options, solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  for (int step = 0; step < 30; ++step) {
    const double t = 0.1 * step;
    const FlatState at = replanner.Reference(t);
    ReplanInput input = Input(at.p_WB, pad, t);
    input.vehicle.v_WB = at.v_WB;
    input.look_from_W = there;
    const ReplanResult& result = replanner.Replan(input, map);
    EXPECT_TRUE(result.certificate.passed()) << t;
    EXPECT_TRUE(result.proven) << t;
    EXPECT_FALSE(result.ends_in_contact);
    EXPECT_LE((at.p_WB - start).norm(), radius - replanner.options().hull_radius) << t;
  }
  EXPECT_LE((replanner.Reference(3.0).p_WB - there).norm(), 0.05) << "a rest is not moved by less";
}

TEST(ReplannerFallback, APlanThatHasHardlyBegunIsFlownOn) {
  const OccupancyMap map = ObservedMap();
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  const ArcPad pad({5.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  Replanner plans(options, solvers::StandardBackends());
  plans.CommitHover(start, 0.0);
  ASSERT_EQ(plans.Replan(Input(start, pad, 0.0), map).status, ReplanStatus::kPlanned);
  options.max_work = 1;  // later steps find none
  Replanner replanner(options, solvers::StandardBackends());
  replanner.Restore(plans.state());
  for (int step = 1; step < 20; ++step) {
    const double t = 0.1 * step;
    const FlatState at = replanner.Reference(t);
    ReplanInput input = Input(at.p_WB, pad, t);
    input.vehicle.v_WB = at.v_WB;
    EXPECT_EQ(replanner.Replan(input, map).status, ReplanStatus::kKept) << t;
  }
  EXPECT_GT((replanner.Reference(2.0).p_WB - start).norm(), 1.0);
}

TEST(ReplannerFallback, APlaceToLookFromIsChecked) {
  const OccupancyMap map = ObservedMap();
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  const ArcPad pad({5.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  for (const double wrong : {std::nan(""), 1e7}) {
    ReplanInput input = Input(start, pad, 0.0);
    input.look_from_W = Eigen::Vector3d(wrong, 0.0, 1.0);
    const ReplanResult& result = replanner.Replan(input, map);
    EXPECT_EQ(result.reason, ReplanReason::kInvalidInput);
    EXPECT_NE(result.detail.find("look_from_W"), std::string_view::npos);
  }
}

TEST(ReplannerFallback, WhoHoldsWithTheHullInHitCellsSaysSo) {
  OccupancyMap map{OccupancyMapOptions{}};
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  map.Recentre(start);
  map.MarkRestFree();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.25, 0.25}) {
      map.SetOccupied(start + side * Eigen::Vector3d::Unit(axis));
    }
  }
  const ReplanResult& result = replanner.Replan(Input(start, pad, 0.1), map);
  EXPECT_EQ(result.status, ReplanStatus::kHolding);
  EXPECT_TRUE(result.certificate.earlier) << "no bound is told of what is not measured again";
  EXPECT_TRUE(result.map_error);
}

TEST(ReplannerFallback, APadThatBecomesNanBringsItToRest) {
  class BrokenPad : public ArcPad {
   public:
    using ArcPad::ArcPad;
    estimation::PadState At(double t) const noexcept override {
      estimation::PadState state = ArcPad::At(t);
      if (broken) state.p_WP.x() = std::numeric_limits<double>::quiet_NaN();
      return state;
    }
    bool broken = false;
  };
  const OccupancyMap map = ObservedMap();
  BrokenPad pad({6.0, 0.0, 0.3}, 0.8, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover({-6.0, 0.0, 1.5}, 0.0);
  for (int step = 0; step < 120; ++step) {
    const double t = 0.1 * step;
    pad.broken = t > 1.5;
    const FlatState at = replanner.Reference(t);
    ReplanInput input = Input(at.p_WB, pad, t);
    input.vehicle.v_WB = at.v_WB;
    const ReplanResult& result = replanner.Replan(input, map);
    EXPECT_EQ(result.reason, pad.broken ? ReplanReason::kInvalidInput : ReplanReason::kNone);
    EXPECT_TRUE(result.certificate.passed());
  }
  EXPECT_LT(replanner.Reference(12.0).v_WB.norm(), 1e-9);
}

TEST(ReplannerFallback, AStartInTheInflatedZoneIsLedOut) {
  OccupancyMap map = ObservedMap(0.4);
  AddPillar({-3.4, 0.0}, &map);  // its face is 0.3 m ahead of the start
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  const Eigen::Vector3d start(-4.0, 0.1, 1.5);
  ASSERT_TRUE(map.IsBlocked(start));
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  Eigen::Vector3d p = start;
  ReplanStatus status = ReplanStatus::kHolding;
  for (int step = 0; step < 30 && status != ReplanStatus::kPlanned; ++step) {
    ReplanInput input = Input(p, pad, 0.1 * step);
    input.vehicle.v_WB = replanner.Reference(input.t_now).v_WB;
    const ReplanResult& result = replanner.Replan(input, map);
    status = result.status;
    EXPECT_TRUE(result.certificate.passed()) << ToString(result.reason) << " at step " << step;
    if (step == 0) {
      // Out of the zone and to rest, or out of it and to the pad at once.
      EXPECT_TRUE(status == ReplanStatus::kEscaping || status == ReplanStatus::kPlanned);
      EXPECT_TRUE(result.certificate.escaping);
      EXPECT_GT(result.certificate.clearance, 0.2);
    }
    p = replanner.Reference(input.t_now + 0.1).p_WB;
  }
  EXPECT_EQ(status, ReplanStatus::kPlanned);
}

TEST(ReplannerFallback, BrakesWhenTheWayCloses) {
  OccupancyMap map = ObservedMap();
  const ArcPad pad({6.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  const Eigen::Vector3d start(-6.0, 0.0, 1.5);
  replanner.CommitHover(start, 0.0);
  // A plan without a newer one is flown to its stop: speeding up takes one at every step.
  double t = 0.0;
  for (; t < 1.95; t += 0.1) {
    const FlatState at = replanner.Reference(t);
    ReplanInput input = Input(at.p_WB, pad, t);
    input.vehicle.v_WB = at.v_WB;
    ASSERT_EQ(replanner.Replan(input, map).status, ReplanStatus::kPlanned);
  }
  // In full flight a wall appears from side to side and top to bottom, 1.8 m ahead.
  const FlatState at = replanner.Reference(t);
  ASSERT_GT(at.v_WB.norm(), 1.5);
  for (double y = -12.75; y < 12.8; y += 0.1) {
    for (double z = -3.15; z < 3.2; z += 0.1) {
      map.SetOccupied({at.p_WB.x() + 1.8, y, z});
    }
  }
  ReplanInput input = Input(at.p_WB, pad, t);
  input.vehicle.v_WB = at.v_WB;
  const ReplanResult& result = replanner.Replan(input, map);
  EXPECT_EQ(result.status, ReplanStatus::kBraking) << ToString(result.reason);
  EXPECT_TRUE(result.certificate.passed());
  // What is flown is the stop that was stored with the last plan.
  const FlightPair flown = replanner.state().next;
  const FlatState end = replanner.Reference(flown.stop.t_end());
  EXPECT_EQ(end.p_WB, flown.stop.Position(flown.stop.t_end()));
  EXPECT_LT(end.v_WB.norm(), 1e-9);
  EXPECT_FALSE(map.IsBlocked(end.p_WB));
}

TEST(ReplannerFallback, ComesToRestOnRequestAndStays) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({6.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  for (const double climb : {0.0, 1.0}) {
    Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
    const Eigen::Vector3d start(-6.0, 0.0, 1.5);
    replanner.CommitHover(start, 0.0);
    ASSERT_EQ(replanner.Replan(Input(start, pad, 0.0), map).status, ReplanStatus::kPlanned);
    double height = 0.0;
    for (int step = 0; step < 40; ++step) {
      const double t = 2.0 + 0.1 * step;
      const FlatState at = replanner.Reference(t);
      ReplanInput input = Input(at.p_WB, pad, t);
      input.pad = nullptr;
      input.vehicle.v_WB = at.v_WB;
      const ReplanStatus status = replanner.Rest(input, climb, map).status;
      if (step == 0) {
        height = at.p_WB.z();
        EXPECT_EQ(status, climb > 0.0 ? ReplanStatus::kClimbing : ReplanStatus::kHolding);
      } else {
        EXPECT_TRUE(status == ReplanStatus::kKept || status == ReplanStatus::kHolding);
      }
    }
    EXPECT_LT(replanner.Reference(6.0).v_WB.norm(), 1e-9);
    EXPECT_NEAR(replanner.Reference(6.0).p_WB.z(), height + climb, 0.15);
  }
}

OccupancyMap BelowARoof(const Eigen::Vector3d& start, double roof) {
  OccupancyMap map = ObservedMap();
  const CellIndex above = map.CellOf(start + Eigen::Vector3d(0.0, 0.0, roof));
  for (int x = -8; x <= 8; ++x) {
    for (int y = -8; y <= 8; ++y) {
      map.SetState(above + CellIndex(x, y, 0), CellState::kOccupied);
    }
  }
  return map;
}

// The mission takes it for the end of a go-around.
TEST(ReplannerFallback, WhoCannotClimbAtAllHolds) {
  const Eigen::Vector3d start(-6.0, 0.0, 1.5);
  const OccupancyMap map = BelowARoof(start, 0.7);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  ReplanInput input = Input(start, ArcPad({6.0, 0.0, 0.3}, 0.0, 0.0, 0.0), 0.0);
  input.pad = nullptr;
  for (int step = 0; step < 10; ++step) {
    input.t_now = input.t_start = input.vehicle.t = 0.1 * step;
    EXPECT_EQ(replanner.Rest(input, 1.5, map).status, ReplanStatus::kHolding);
  }
}

// Before, a vehicle that could not climb in full stayed low in the pad's way.
TEST(ReplannerFallback, BelowARoofAPartOfTheClimbIsFlownOnce) {
  const Eigen::Vector3d start(-6.0, 0.0, 1.5);
  const OccupancyMap map = BelowARoof(start, 1.5);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  ReplanInput input = Input(start, ArcPad({6.0, 0.0, 0.3}, 0.0, 0.0, 0.0), 0.0);
  input.pad = nullptr;
  EXPECT_EQ(replanner.Rest(input, 1.6, map).status, ReplanStatus::kClimbing);
  for (int step = 1; step < 40; ++step) {
    const FlatState at = replanner.Reference(0.1 * step);
    input.t_now = input.vehicle.t = 0.1 * step;
    input.t_start = input.t_now;
    input.vehicle.p_WB = at.p_WB;
    input.vehicle.v_WB = at.v_WB;
    const ReplanResult& result = replanner.Rest(input, 1.6, map);
    EXPECT_NE(result.status, ReplanStatus::kClimbing);
    EXPECT_TRUE(result.certificate.stops_in_observed_space);
  }
  EXPECT_NEAR(replanner.Reference(4.0).p_WB.z(), start.z() + 0.8, 1e-6);
}

// The clearance of plans holds for plans only: the hull may stop where they could not pass.
TEST(ReplannerFallback, AStopThatIsProvenNeedsNoMore) {
  OccupancyMap map = ObservedMap(0.5);
  for (double x = -1.0; x < 3.0; x += 0.1) {
    for (double z = 0.05; z < 3.0; z += 0.1) {
      for (const double y : {-0.45, 0.45}) map.SetOccupied({x, y, z});
    }
  }
  FreeSpace space;
  space.map = &map;
  HullSpace hull;
  hull.space = &space;
  hull.hull_radius = 0.324;
  hull.margin = 0.04;
  const Limits limits;
  ReplanResult result;
  const SplineState start{{0.0, 0.0, 1.5}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  const auto rests = [&](Fallback::Room room) {
    return Fallback(limits).Rests(0.0, start, {0.0, 0.0, 0.0}, hull, room, &result);
  };
  EXPECT_FALSE(rests(Fallback::Room::kPlanClearance));
  ASSERT_TRUE(rests(Fallback::Room::kHullClearance));
  EXPECT_FALSE(result.certificate.clear);
  EXPECT_TRUE(result.certificate.stops_in_observed_space);
  hull.margin = 0.12;
  EXPECT_FALSE(rests(Fallback::Room::kHullClearance));
}

TEST(ReplannerFallback, AStartThatCannotBrakeIsNotTriedLater) {
  // Too near to the wall, and too fast: no arrival time changes that.
  OccupancyMap map = ObservedMap();
  for (double y = -6.0; y <= 6.0; y += 0.5) AddPillar({1.5, y}, &map);
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.max_work = 200000;  // a way around is found, but it takes too long
  Replanner replanner(options, solvers::StandardBackends());
  ReplanLog log;
  replanner.set_log(&log);
  const Eigen::Vector3d start(0.0, 0.0, 1.6), v_WB(2.8, 0.0, 0.0);
  FlyAlong(start, v_WB, &replanner);
  const ArcPad pad({6.0, 0.0, 0.3}, 0.3, 0.0, 0.0);
  ReplanInput input = Input(start, pad, 0.0);
  input.vehicle.v_WB = v_WB;
  const ReplanResult& result = replanner.Replan(input, map);
  EXPECT_EQ(result.reason, ReplanReason::kCollisionRemains);
  EXPECT_EQ(log.attempts.size(), 1u);
}

}  // namespace
}  // namespace touchdown::planning
