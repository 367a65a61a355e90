// SPDX-License-Identifier: BSD-3-Clause
#include "planning/look/lookout.h"

#include <cmath>

#include <gtest/gtest.h>

#include "planning/look/sight.h"
#include "planning/replan/spaces.h"
#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/replan/goal.h"

namespace touchdown::planning {
namespace {

const Eigen::Vector3d kCalm = Eigen::Vector3d::Zero();

/// Ahead, level, 90 degrees wide and 74 high.
LookCamera Ahead() {
  LookCamera camera;
  camera.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.reach = 4.0;
  return camera;
}

TEST(Sight, IsThePyramidOfTheImageUpToTheReach) {
  const Sight sight(Ahead(), {{1.0, 2.0, 3.0}, M_PI / 2}, kCalm);  // looks along y
  EXPECT_TRUE(sight.Holds({1.0, 4.0, 3.0}));
  EXPECT_FALSE(sight.Holds({1.0, 0.0, 3.0}));
  EXPECT_FALSE(sight.Holds({1.0, 6.1, 3.0})) << "beyond the reach";
  EXPECT_FALSE(sight.Holds({1.0, 2.2, 3.0})) << "too near";
  const double half_width = std::atan(1.0), half_height = std::atan(0.75);
  for (const double off : {-0.05, 0.12}) {  // outside, and inside of the margin
    EXPECT_EQ(sight.Holds({1.0 + 2.0 * std::tan(half_width - off), 4.0, 3.0}), off > 0.0);
    EXPECT_EQ(sight.Holds({1.0, 4.0, 3.0 - 2.0 * std::tan(half_height - off)}), off > 0.0);
  }
}

TEST(Sight, LeansAgainstThePull) {
  // It is pushed backwards, so it leans ahead and sees lower.
  const Sight sight(Ahead(), {{0.0, 0.0, 3.0}, 0.0}, {-2.0, 0.0, 0.0});
  const Eigen::Vector3d low(2.0, 0.0, 3.0 - 2.0 * std::tan(0.75));
  EXPECT_TRUE(sight.Holds(low));
  EXPECT_FALSE(Sight(Ahead(), {{0.0, 0.0, 3.0}, 0.0}, kCalm).Holds(low));
}

TEST(Sight, EndsAtWhatBlocks) {
  OccupancyMap map{OccupancyMapOptions{}};
  const Sight sight(Ahead(), {{0.05, 0.05, 1.05}, 0.0}, kCalm);
  const CellIndex behind(30, 0, 10);
  EXPECT_TRUE(sight.Reaches(behind, map));
  map.SetOccupied(map.CentreOf({15, 0, 10}));
  EXPECT_FALSE(sight.Reaches(behind, map));
  EXPECT_TRUE(sight.Reaches({15, 0, 10}, map)) << "an obstacle itself is in sight";
  EXPECT_TRUE(sight.Reaches({15, 3, 10}, map));
}

class Survey : public ::testing::Test {
 protected:
  Survey() : space_(SpaceFor(options_, map_)) { Start(2.05); }
  void Start(double height) {
    at_.z() = height;
    map_.Recentre(at_);
    vehicle_.p_WB = at_;
  }
  /// As high as the window.
  void Wall(double x, double y_from, double y_to) {
    for (double y = y_from; y < y_to; y += 0.1) {
      for (double z = 0.05; z < 6.0; z += 0.1) map_.SetOccupied({x, y, z});
    }
  }
  HullSpace Hull() const { return HullFor(options_, space_, 0.04, nullptr); }

  const ReplannerOptions options_;
  OccupancyMap map_{OccupancyMapOptions{}};
  Eigen::Vector3d at_ = {0.05, 0.05, 0.0};
  FreeSpace space_;
  estimation::VehicleState vehicle_;
  Lookout lookout_{PathCost{2.0, 8.0}};
};

TEST_F(Survey, ThePotentialIsTheShortestWay) {
  EXPECT_NEAR(lookout_.Length(space_, at_, at_ + Eigen::Vector3d(5.0, 0.0, 0.0)), 5.0, 0.1);
  EXPECT_NEAR(lookout_.Length(space_, at_, at_ + Eigen::Vector3d(0.0, 0.0, 1.0)), 2.0, 0.1)
      << "up costs twice";
  EXPECT_NEAR(lookout_.Length(space_, at_, at_ + Eigen::Vector3d(60.0, 0.0, 0.0)), 60.0, 0.1)
      << "out of the window it is straight";
  Wall(2.5, -13.0, 3.0);
  EXPECT_GT(lookout_.Length(space_, at_, at_ + Eigen::Vector3d(5.0, 0.0, 0.0)), 7.0);
  Wall(2.5, 3.0, 13.0);
  EXPECT_GT(lookout_.Length(space_, at_, at_ + Eigen::Vector3d(5.0, 0.0, 0.0)), 12.0);
  EXPECT_EQ(lookout_.end(), SpanSearch::End::kSide) << "to both sides the wall may end there";
}

TEST_F(Survey, ClosedIsWhatEnclosesTheVehicleOrTheGoal) {
  const Eigen::Vector3d goal = at_ + Eigen::Vector3d(5.0, 0.0, 0.0);
  const auto closed = [&] {
    lookout_.Length(space_, at_, goal);
    return lookout_.Closed(space_, at_, goal);
  };
  EXPECT_FALSE(closed());
  Wall(2.5, -13.0, 13.0);
  EXPECT_FALSE(closed()) << "the wall may end outside";
  space_.ceiling = 4.0;
  for (double x = 2.5; x < 8.0; x += 0.1) {
    for (double z = 0.05; z < 5.0; z += 0.1) {
      map_.SetOccupied({x, -2.5, z});
      map_.SetOccupied({x, 2.5, z});
    }
  }
  EXPECT_FALSE(closed());
  Wall(8.0, -2.5, 2.5);
  EXPECT_TRUE(closed());
  space_.ceiling = 30.0;
  EXPECT_FALSE(closed()) << "over the walls nothing was seen";
}

// A dead end that is larger than the window: what was seen of it on the way in counts on the way out.
TEST_F(Survey, TheFarPathKnowsWhatIsOutOfTheWindow) {
  space_.ceiling = 4.0;
  const Eigen::Vector3d goal = at_ + Eigen::Vector3d(20.0, 0.0, 0.0);
  const auto build = [&](double shift) {  // the same walls in a window around another place
    map_ = OccupancyMap{OccupancyMapOptions{}};
    map_.Recentre(at_ + Eigen::Vector3d(shift, 0.0, 0.0));
    Wall(12.05, -4.0, 4.0);
    for (double x = -20.0; x < 12.05; x += 0.1) {
      for (double z = 0.05; z < 5.0; z += 0.1) {
        map_.SetOccupied({x, -4.0, z});
        map_.SetOccupied({x, 4.0, z});
      }
    }
  };
  lookout_.Prepare(space_);
  for (const double shift : {0.0, -12.0}) {
    build(shift);
    lookout_.Keep(space_);
  }
  const Eigen::Vector3d here = at_ - Eigen::Vector3d(12.0, 0.0, 0.0);
  EXPECT_NEAR(lookout_.Length(space_, here, goal), 32.0, 0.3) << "straight on";
  lookout_.TakePath(space_, here, goal, false, true);
  map_.MarkRestFree();
  lookout_.NoteNeeded(Hull(), here);
  EXPECT_GT(lookout_.seen(), 8.0 + 12.0) << "out and around, all that is in the window";
  const Look* onwards = lookout_.Onwards(0.0, {});
  ASSERT_TRUE(onwards);
  EXPECT_GT(std::abs(onwards->from.p_WB.y()), 4.0);
  EXPECT_FALSE(lookout_.Onwards(0.0, {onwards->from})) << "it is struck";
}

TEST_F(Survey, WhatWasSeenIsNotNeeded) {
  const Eigen::Vector3d goal = at_ + Eigen::Vector3d(4.0, 0.0, 0.0);
  lookout_.Length(space_, at_, goal);
  EXPECT_TRUE(lookout_.NoteNeeded(Hull(), at_));
  map_.MarkRestFree();
  EXPECT_FALSE(lookout_.NoteNeeded(Hull(), at_));
}

// The column below was never seen. The vehicle is in a ball of seen space, which the camera's image of its own place
// does not hold.
TEST_F(Survey, LooksAtAColumnFromItsSide) {
  Start(4.05);
  map_.MarkFree(at_, 2.5);
  const HullSpace hull = Hull();
  ASSERT_TRUE(std::isfinite(lookout_.Length(space_, at_, {0.05, 0.05, 1.05})));
  ASSERT_TRUE(lookout_.NoteNeeded(hull, at_));
  std::vector<Viewpoint> struck;
  for (int i = 0; i < 5; ++i) {
    const Look* look = lookout_.Choose(hull, {Ahead()}, vehicle_, kCalm, struck);
    ASSERT_TRUE(look);
    const Eigen::Vector3d off = look->from.p_WB - at_;
    EXPECT_GT(off.head<2>().norm(), 0.3);
    EXPECT_LT(off.norm() + hull.radius(), 2.55) << "the hull stays in what was seen";
    EXPECT_GE(look->way, off.norm() - 1e-9);
    EXPECT_GT(look->cells.size(), i == 0 ? 20U : 0U);
    const Sight sight(Ahead(), look->from, kCalm);
    for (const CellIndex& cell : look->cells) {
      EXPECT_TRUE(sight.Holds(map_.CentreOf(cell)));
      EXPECT_FALSE(map_.IsObservedFree(cell));
    }
    for (const Viewpoint& old : struck) {
      EXPECT_TRUE((old.p_WB - look->from.p_WB).norm() >= 0.4 ||
                  std::abs(estimation::WrapAngle(old.yaw - look->from.yaw)) >= 0.5);
    }
    struck.push_back(look->from);
  }
}

TEST_F(Survey, WhereNothingCanBeSeenThereIsNoPlace) {
  map_.MarkFree(at_, 2.5);
  lookout_.Length(space_, at_, at_ + Eigen::Vector3d(6.0, 0.0, 0.0));
  ASSERT_TRUE(lookout_.NoteNeeded(Hull(), at_));
  LookCamera blind = Ahead();
  blind.reach = 0.3;
  EXPECT_FALSE(lookout_.Choose(Hull(), {blind}, vehicle_, kCalm, {}));
  EXPECT_TRUE(lookout_.Choose(Hull(), {blind, Ahead()}, vehicle_, kCalm, {}));
}

// Above a roof there are hundreds of nearer places, with what is below in their image.
TEST_F(Survey, OfManyPlacesThoseCountThatSeePastObstacles) {
  Start(4.05);
  for (double x = -11.0; x < 11.0; x += 0.1) {
    for (double y = -11.0; y < 11.0; y += 0.1) map_.SetOccupied({x, y, 2.75});
  }
  map_.MarkRestFree();
  for (int x = -20; x < 20; ++x) {
    for (int y = -20; y < 20; ++y) {
      for (int z = 3; z < 16; ++z) map_.SetState({x, y, z}, CellState::kUnknown);
    }
  }
  lookout_.Length(space_, at_, {0.05, 0.05, 1.05});
  ASSERT_TRUE(lookout_.NoteNeeded(Hull(), at_));
  LookCamera camera = Ahead();
  camera.reach = 9.0;
  const Look* look = lookout_.Choose(Hull(), {camera}, vehicle_, kCalm, {});
  ASSERT_TRUE(look);
  EXPECT_LT(look->from.p_WB.z(), 3.0);
  EXPECT_FALSE(look->cells.empty());
}

TEST_F(Survey, AStraightWayLeadsWhereTheWholeHullSweepsFreeCells) {
  map_.MarkFree(at_, 0.8);
  const auto leads = [&](double length) {
    const Eigen::Vector3d to = at_ + Eigen::Vector3d(length, 0.0, 0.0);
    map_.MarkFree(to, 0.8);
    return lookout_.Leads(Hull(), at_, to);
  };
  EXPECT_FALSE(leads(1.5)) << "0.28 m beside the way's middle cells are unseen";
  EXPECT_TRUE(leads(1.0));
}

// Through a gap hardly wider than the hull, places on a coarse lattice are not connected.
TEST_F(Survey, PlacesBehindAGapOnTheWayAreReached) {
  Wall(3.05, -13.0, -0.6);
  Wall(3.05, 0.75, 13.0);
  for (double x = 0.0; x < 8.0; x += 0.5) map_.MarkFree({x, 0.05, 2.05}, 3.0);
  const Eigen::Vector3d goal = at_ + Eigen::Vector3d(12.0, 0.0, 0.0);
  ASSERT_TRUE(std::isfinite(lookout_.Length(space_, at_, goal)));
  ASSERT_TRUE(lookout_.NoteNeeded(Hull(), at_));
  const Look* look = lookout_.Choose(Hull(), {Ahead()}, vehicle_, kCalm, {});
  ASSERT_TRUE(look);
  EXPECT_GT(look->from.p_WB.x(), 3.5);
}

// In a shaft there are more places within a step than are looked at (flight 251 of seed 64120 never came out of one).
TEST_F(Survey, PlacesOutOfAShaftAreReached) {
  Start(1.05);
  for (double z = 0.05; z < 3.0; z += 0.1) {  // it leans at first: long steps end in its walls
    const double middle = 0.05 + 0.6 * (std::min(z, 1.65) - 1.05);
    for (double y = -1.25; y < 1.4; y += 0.1) {
      for (const double side : {-0.7, 0.7}) map_.SetOccupied({middle + side, y, z});
    }
    for (double x = -0.6; x < 0.65; x += 0.1) {
      for (const double y : {-1.25, 1.35}) map_.SetOccupied({middle + x, y, z});
    }
  }
  map_.MarkRestFree();
  const Look* look = lookout_.Highest(Hull(), at_, at_ + Eigen::Vector3d(5.0, 0.0, 0.0));
  ASSERT_TRUE(look);
  EXPECT_GT(look->from.p_WB.z(), 3.5);
  for (std::size_t i = 1; i < look->way_W.size(); ++i) {
    EXPECT_LT((look->way_W[i] - look->way_W[i - 1]).norm(), 2.1);
  }
}

}  // namespace
}  // namespace touchdown::planning
