// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/look/scout.h"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/replan/goal.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

ReplannerOptions BelowACeiling() {
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.ceiling_height = 5.0;
  return options;
}

/// From side to side of the window, up to the ceiling or so high [m].
void WallAcross(OccupancyMap* map, double x, double height = 5.3) {
  const double middle = map->CentreOf(map->origin() + map->size() / 2).y();
  for (double y = middle - 13.0; y < middle + 13.0; y += 0.1) {
    for (double z = 0.05; z < height; z += 0.1) map->SetOccupied({x, y, z});
  }
}

/// Asks a scout ten times a second about a vehicle that was moved by hand.
class Scouted : public ::testing::Test {
 protected:
  Scouted() {
    map_.Recentre(p_);
    map_.MarkFree(p_, 2.5);
    LookCamera camera;
    camera.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    camera.reach = 4.0;
    cameras_ = {camera};
  }

  std::optional<Viewpoint> Step(const Eigen::Vector3d& v = Eigen::Vector3d::Zero(), int images = 1,
                                bool may_look = true) {
    t_ += 0.1;
    p_ += 0.1 * v;
    cameras_[0].images += images;
    ReplanInput input = Input(p_, *pad_, t_);
    input.vehicle.v_WB = v;
    input.vehicle.q_WB = Eigen::AngleAxisd(yaw_, Eigen::Vector3d::UnitZ());
    input.endpoint.height = input.endpoint.height_floor = 0.0;
    return scout_.Step(input, cameras_, map_, may_look);
  }
  /// The time at which the standing vehicle first looks; infinite: not within 10 s.
  double FirstLook(int images_every = 1, bool may_look = true) {
    for (int i = 0; i < 100; ++i) {
      look_ = Step(Eigen::Vector3d::Zero(), i % images_every == 0, may_look);
      if (look_) return t_;
    }
    return std::numeric_limits<double>::infinity();
  }
  bool ClimbsOnceToAndFro() {
    for (int i = 0; i < 800; ++i) {
      look_ = Step({0.0, i / 30 % 2 == 0 ? 1.0 : -1.0, 0.0});
      if (look_ && look_->p_WB.z() > p_.z() + 0.5) return true;
    }
    return false;
  }
  void GoThere() {
    p_ = look_->p_WB;
    yaw_ = look_->yaw;
  }

  double t_ = 0.0, yaw_ = 0.0;
  Eigen::Vector3d p_ = {0.05, 0.05, 2.05};
  OccupancyMap map_{OccupancyMapOptions{}};
  std::unique_ptr<estimation::PadPrediction> pad_ =
      std::make_unique<GoalAt>(Eigen::Vector3d(8.0, 0.05, 2.05));
  std::vector<LookCamera> cameras_;
  Scout scout_{BelowACeiling()};
  std::optional<Viewpoint> look_;
};

TEST_F(Scouted, WhoStandsBeforeUnseenSpaceLooksAfterAWhile) {
  const double t = FirstLook();
  EXPECT_GE(t, 2.5);
  EXPECT_LE(t, 3.5);
  EXPECT_TRUE(Step()) << "and goes on doing so";
}

TEST_F(Scouted, WithRareImagesLater) {
  const double t = FirstLook(10);  // one a second
  EXPECT_GE(t, 5.0);
  EXPECT_LE(t, 8.0);
}

TEST_F(Scouted, NeverWithoutACameraOrWhereItMayNot) {
  EXPECT_TRUE(std::isinf(FirstLook(1, false)));
  for (int i = 0; i < 100; ++i) {
    t_ += 0.1;
    EXPECT_FALSE(scout_.Step(Input(p_, *pad_, t_), {}, map_, true));
  }
}

TEST_F(Scouted, NotInFlightWhereAllThatIsNeededWasSeen) {
  map_.MarkRestFree();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(Step({0.0, i / 10 % 2 == 0 ? 1.0 : -1.0, 0.0}));
}

// In a gust the margins leave no way out of what was seen around the start, and what is needed is above and below what
// the camera sees from there: it turns on the spot.
TEST_F(Scouted, WhoReachesNoPlaceLooksAround) {
  cameras_[0].reach = 0.05;
  for (int quarter = 1; quarter <= 5; ++quarter) {
    ASSERT_LT(FirstLook(), 100.0);
    EXPECT_EQ(look_->p_WB, p_);
    const double turned = 0.5 * std::numbers::pi * quarter;
    EXPECT_NEAR(estimation::WrapAngle(look_->yaw - turned), 0.0, 1e-9);
    GoThere();
    for (int i = 0; Step(); ++i) ASSERT_LT(i, 10) << "three images";
    yaw_ = 0.0;  // to its goal again, for as long as it does not look
  }
}

// It waited here, and comes down now.
TEST_F(Scouted, NotWhereItHasJustBegunToMove) {
  map_.MarkRestFree();
  EXPECT_TRUE(std::isinf(FirstLook(1, false)));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(Step({0.3, 0.0, 0.0}));
}

// No plan leads to the goal, although all on the way was seen: it goes there in parts, shorter and shorter ones.
TEST_F(Scouted, FromRestItGoesInParts) {
  map_.MarkRestFree();
  FirstLook();
  ASSERT_TRUE(look_);
  const Eigen::Vector3d goal = pad_->At(0.0).p_WP;
  EXPECT_LT((look_->p_WB - goal).norm(), 0.2);
  double before = (goal - p_).norm();
  for (int part = 0; part < 3; ++part) {
    const double since = t_;
    while (look_ && (look_->p_WB - p_).norm() > 0.9 * before) look_ = Step();
    ASSERT_TRUE(look_);
    EXPECT_NEAR(t_ - since, 0.7, 0.3);
    EXPECT_NEAR((look_->p_WB - p_).norm(), 0.5 * before, 0.2);
    before = (look_->p_WB - p_).norm();
  }
  GoThere();
  EXPECT_FALSE(Step()) << "the planner may come on from here";
}

// The way there is upright: no reason to turn.
TEST_F(Scouted, KeepsItsHeadingOnTheWayUp) {
  map_.MarkRestFree();
  pad_ = std::make_unique<GoalAt>(p_ + Eigen::Vector3d(0.0, 0.0, 2.0));
  yaw_ = 2.5;
  FirstLook();
  ASSERT_TRUE(look_);
  EXPECT_NEAR(look_->yaw, 2.5, 1e-9);
}

TEST_F(Scouted, NotAtTheGoal) {
  p_ = pad_->At(0.0).p_WP + Eigen::Vector3d(0.2, 0.0, 0.0);
  map_.MarkFree(p_, 2.5);
  EXPECT_TRUE(std::isinf(FirstLook()));
}

TEST_F(Scouted, NotWhileItComesNearer) {
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(Step({0.2, 0.0, 0.0})) << t_;
}

// Without what its own stop needs there is no plan at the goal, either: it looked nowhere in an open field.
TEST_F(Scouted, AtTheGoalIfItIsAmongUnseenCells) {
  pad_ = std::make_unique<GoalAt>(p_ + Eigen::Vector3d(0.2, 0.0, 0.0));
  for (int z = 12; z < 18; ++z) map_.SetState({2, 0, z}, CellState::kUnknown);
  EXPECT_LE(FirstLook(), 3.5);
}

// To and fro is no progress: rest is not waited for.
TEST_F(Scouted, ToAndFroIsNoProgress) {
  bool looks = false;
  for (int i = 0; i < 60 && !looks; ++i) {
    looks = Step({i / 8 % 2 == 0 ? 0.8 : -0.8, 0.0, 0.0}).has_value();
  }
  EXPECT_TRUE(looks);
}

TEST_F(Scouted, WhoFollowsAGoalThatDrivesAheadMakesProgress) {
  pad_ = std::make_unique<MovingGoal>([](const Taylor& t) {
    return MovingGoal::Position{3.0 + 0.6 * t, 0.05 + 0.0 * t, 2.05 + 0.0 * t};
  });
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(Step({0.6, 0.0, 0.0})) << t_;
}

TEST_F(Scouted, EndsWhenTheCellsWereSeen) {
  FirstLook();
  ASSERT_TRUE(look_);
  map_.MarkRestFree();
  EXPECT_FALSE(Step());
}

TEST_F(Scouted, APlaceIsStruckAfterThreeImagesInVain) {
  FirstLook();
  ASSERT_TRUE(look_);
  GoThere();
  int images = 0;
  while (images < 20 && Step(Eigen::Vector3d::Zero(), 1)) ++images;
  EXPECT_EQ(images, 3);
  const Viewpoint first = *look_;
  FirstLook();
  ASSERT_TRUE(look_);
  EXPECT_TRUE((look_->p_WB - first.p_WB).norm() >= 0.4 ||
              std::abs(estimation::WrapAngle(look_->yaw - first.yaw)) >= 0.5);
}

// While it brakes there it leans, and its camera looks elsewhere.
TEST_F(Scouted, ImagesCountFromWhereItHovers) {
  FirstLook();
  ASSERT_TRUE(look_);
  GoThere();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(Step({0.0, i % 2 == 0 ? 1.0 : -1.0, 0.0})) << i;
  for (int i = 0; i < 4; ++i) look_ = Step();
  EXPECT_FALSE(look_);
}

TEST_F(Scouted, APlaceThatIsNotReachedIsStruck) {
  FirstLook();
  ASSERT_TRUE(look_);
  p_ = look_->p_WB + Eigen::Vector3d(-1.0, 0.0, 0.0);
  Step();
  const double stands_since = t_;
  while (t_ < stands_since + 10.0 && Step()) {
  }
  EXPECT_NEAR(t_ - stands_since, 2.6, 0.3);
}

// To and fro before a wall that has no end in sight.
TEST_F(Scouted, AfterALongDetourItClimbs) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05, 3.5);
  ASSERT_TRUE(ClimbsOnceToAndFro());
  EXPECT_NEAR(look_->yaw, 0.0, 1.0) << "it faces the wall";
}

// Nor where a roof is over the goal.
TEST_F(Scouted, NotWhereTheWallReachesTheCeiling) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05);
  EXPECT_FALSE(ClimbsOnceToAndFro());
}

/// As high as the window, and round about: from 3 m to 3.2 m off.
void CloseIn(OccupancyMap* map) {
  for (double a = -3.15; a <= 3.25; a += 0.1) {
    for (double z = 0.05; z < 5.3; z += 0.1) {
      for (const double b : {-3.05, 3.15}) {
        map->SetOccupied({a, b, z});
        map->SetOccupied({b, a, z});
      }
    }
  }
}

TEST_F(Scouted, WhereWhatWasSeenClosesEveryWayThereIsNone) {
  map_.MarkRestFree();
  CloseIn(&map_);
  int step = 0;
  while (step < 300 && !scout_.no_way()) {
    look_ = Step();
    if (look_) GoThere();
    ++step;
  }
  ASSERT_TRUE(scout_.no_way());
  EXPECT_GE(scout_.no_way()->since, 2.5);
  for (int y = -7; y < 8; ++y) {  // a door opens
    for (int z = 0; z < 54; ++z) map_.SetState({31, y, z}, CellState::kFree);
  }
  for (int i = 0; i < 60; ++i) {  // it looks around, and asks again
    look_ = Step();
    if (look_) GoThere();
  }
  EXPECT_FALSE(scout_.no_way());
}

TEST_F(Scouted, EveryTimeThatItIsClosedInItLooksAround) {
  map_.MarkRestFree();
  for (const char* time : {"first", "second"}) {
    CloseIn(&map_);
    int looks = 0;
    for (int i = 0; i < 300; ++i) {
      look_ = Step();
      if (!look_) continue;
      ++looks;
      GoThere();
    }
    EXPECT_GT(looks, 3) << time;
    EXPECT_TRUE(scout_.no_way()) << time;
    map_ = OccupancyMap{OccupancyMapOptions{}};
    map_.Recentre(p_);
    map_.MarkRestFree();
    for (int i = 0; i < 50; ++i) Step({0.5, 0.0, 0.0});  // it flies on
    EXPECT_FALSE(scout_.no_way()) << time;
    p_.x() = 0.05;
  }
}

TEST_F(Scouted, ThereIsAWayToAGoalThatMoves) {
  map_.MarkRestFree();
  CloseIn(&map_);
  pad_ = std::make_unique<MovingGoal>([](const Taylor& t) {
    return MovingGoal::Position{8.0 + 0.0 * t, 0.05 + 0.4 * t, 2.05 + 0.0 * t};
  });
  for (int i = 0; i < 200; ++i) {
    look_ = Step();
    if (look_) GoThere();
    EXPECT_FALSE(scout_.no_way()) << "it may come out by itself";
  }
}

TEST_F(Scouted, AfterALongDetourItClimbsForAGoalThatMoves) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05, 3.5);
  pad_ = std::make_unique<MovingGoal>([](const Taylor& t) {
    return MovingGoal::Position{8.0 + 0.0 * t, 0.05 + 0.2 * t, 2.05 + 0.0 * t};
  });
  EXPECT_TRUE(ClimbsOnceToAndFro());
}

TEST_F(Scouted, ThereMayBeAWayAroundTheWindow) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05);
  for (int i = 0; i < 300; ++i) {
    look_ = Step();
    if (look_) GoThere();
    EXPECT_FALSE(scout_.no_way()) << t_;
  }
}

// All that is in the window was seen: it goes where the way leads on, and does not stop at the places on it.
TEST_F(Scouted, FollowsTheWayOutOfTheWindow) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05);
  FirstLook();
  ASSERT_TRUE(look_);
  EXPECT_GT((look_->p_WB - p_).norm(), 5.0);
  EXPECT_LT(look_->p_WB.x(), 3.0);
  const double side = look_->p_WB.y() > p_.y() ? 1.0 : -1.0;
  double farthest = 0.0;
  for (int i = 0; i < 100; ++i) {
    const auto look = Step({0.0, 1.0 * side, 0.0});
    map_.Recentre(p_);
    WallAcross(&map_, 3.05);
    map_.MarkRestFree();
    ASSERT_TRUE(look) << t_;
    farthest = std::max(farthest, side * (look->p_WB - p_).y());
    EXPECT_GT(side * (look->p_WB - p_).y(), 0.0) << t_;
  }
  EXPECT_GT(farthest, 5.0);
}

TEST_F(Scouted, WhatThePlannerRefusesIsPassedBy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    pad_ = std::make_unique<MovingGoal>([nan](const Taylor& t) {
      return MovingGoal::Position{nan + 0.0 * t, 0.05 + 0.0 * t, 2.05 + 0.0 * t};
    });
    EXPECT_FALSE(Step());
  }
}

TEST_F(Scouted, SaysWhyALookBeginsAndEnds) {
  EXPECT_EQ(scout_.look_words(), "");
  FirstLook();
  ASSERT_TRUE(look_);
  EXPECT_EQ(scout_.look_words(), "begins: no progress, and cells on the way were never seen");
  map_.MarkRestFree();
  EXPECT_FALSE(Step());
  EXPECT_EQ(scout_.look_words(), "ends: seen");
}

// What blocks the goal's place may never have been there.
TEST_F(Scouted, LooksAtWhatBlocksTheGoal) {
  map_.MarkRestFree();
  map_.SetOccupied(pad_->At(0.0).p_WP);
  p_ = pad_->At(0.0).p_WP - Eigen::Vector3d(2.0, 0.0, 0.0);
  FirstLook();
  ASSERT_TRUE(look_);
  EXPECT_NEAR(std::cos(look_->yaw - std::atan2(0.0, 8.0 - look_->p_WB.x())), 1.0, 0.6);
  map_.SetState(map_.CellOf(pad_->At(0.0).p_WP), CellState::kFree);
  EXPECT_FALSE(Step()) << "it was seen free";
}

// A place on the way is not reached: it tries parts of the way, gives it up, and asks again later.
TEST_F(Scouted, AWayOutThatFailsIsStruckOff) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05);
  double since = t_, longest = 0.0;
  int looks = 0;
  for (int i = 0; i < 600; ++i) {
    const bool looked = look_.has_value();
    look_ = Step();
    if (look_ && !looked) ++looks;
    if (!look_) since = t_;
    longest = std::max(longest, t_ - since);
  }
  EXPECT_GT(looks, 2);
  EXPECT_LT(longest, 8.0);
}

// A pen that drives: it may come out. Asked at once after a look, too.
TEST_F(Scouted, APenThatDrivesIsNoNoWay) {
  map_.MarkRestFree();
  pad_ = std::make_unique<MovingGoal>([](const Taylor& t) {
    return MovingGoal::Position{8.0 + 0.0 * t, 0.05 + 0.25 * t, 2.05 + 0.0 * t};
  });
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d goal = pad_->At(t_).p_WP;
    for (double a = -1.5; a <= 1.5; a += 0.1) {
      for (double z = 0.05; z < 5.3; z += 0.1) {
        for (const double b : {-1.5, 1.5}) {
          map_.SetOccupied({goal.x() + a, goal.y() + b, z});
          map_.SetOccupied({goal.x() + b, goal.y() + a, z});
        }
      }
    }
    look_ = Step();
    if (look_) GoThere();
    EXPECT_FALSE(scout_.no_way()) << t_;
  }
}

// What was flown beside the goal is no detour to the next one.
TEST_F(Scouted, NoEarlyClimbAfterATimeAtTheGoal) {
  map_.MarkRestFree();
  for (int i = 0; i < 2000; ++i) {
    pad_ = std::make_unique<GoalAt>(p_);
    Step({i / 10 % 2 == 0 ? 0.3 : -0.3, 0.0, 0.0});
  }
  WallAcross(&map_, p_.x() + 3.0);
  pad_ = std::make_unique<GoalAt>(p_ + Eigen::Vector3d(8.0, 0.0, 0.0));
  for (int i = 0; i < 60; ++i) {
    look_ = Step({0.0, i / 30 % 2 == 0 ? 1.0 : -1.0, 0.0});
    EXPECT_FALSE(look_ && look_->p_WB.z() > p_.z() + 0.5) << i;
  }
}

TEST_F(Scouted, DoesNotAllocateInFlight) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  scout_.Prepare(map_);
  long allocations = 0;
  int looks = 0;
  const auto stay = [&](bool follows) {
    for (int i = 0; i < 600; ++i) {
      t_ += 0.1;
      cameras_[0].images += i % 200 < 100;  // and none for long
      ReplanInput input = Input(p_, *pad_, t_);
      input.endpoint.height = input.endpoint.height_floor = 0.0;
      const long before = solvers::AllocationCount();
      look_ = scout_.Step(input, cameras_, map_, true);
      allocations += solvers::AllocationCount() - before;
      looks += look_.has_value();
      if (look_ && follows && i % 20 == 0) GoThere();
    }
  };
  for (const bool follows : {false, true}) stay(follows);  // among unseen cells
  map_.MarkRestFree();
  for (const double height : {3.5, 5.3}) {  // along a wall, and over it
    WallAcross(&map_, 3.05, height);
    for (const bool follows : {false, true}) stay(follows);
  }
  CloseIn(&map_);
  stay(true);
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(looks, 500);
}

// What it measures of its own place trembles.
TEST_F(Scouted, WhoHoversFliesNoDetour) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05, 3.5);
  for (int i = 0; i < 1500; ++i) {
    look_ = Step({0.0, i % 2 == 0 ? 0.3 : -0.3, 0.0});
    EXPECT_FALSE(look_ && look_->p_WB.z() > p_.z() + 0.5) << t_;
  }
}

// A second camera, which sees nothing of it, is no reason to give a place up.
TEST_F(Scouted, OnlyTheCameraThatIsToSeeItCounts) {
  FirstLook();
  ASSERT_TRUE(look_);
  GoThere();
  LookCamera down = cameras_[0];
  down.R_BC << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  cameras_.push_back(down);
  for (int i = 0; i < 10; ++i) {
    cameras_[1].images += 5;
    EXPECT_TRUE(Step(Eigen::Vector3d::Zero(), 0)) << i;
  }
  for (int i = 0; i < 4; ++i) look_ = Step();
  EXPECT_FALSE(look_);
}

// Who landed meanwhile, or hardly is asked, begins anew.
TEST_F(Scouted, AClimbIsOverWhereItMayNotLook) {
  map_.MarkRestFree();
  WallAcross(&map_, 3.05, 3.5);
  ASSERT_TRUE(ClimbsOnceToAndFro());
  EXPECT_FALSE(Step(Eigen::Vector3d::Zero(), 1, false));
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(Step()) << i;
}

// Away from a goal to which nothing is in the way: no detour, however long.
TEST_F(Scouted, NoClimbWhereTheWayIsStraight) {
  map_.MarkRestFree();
  for (int i = 0; i < 400; ++i) {
    EXPECT_FALSE(Step({0.0, i / 30 % 2 == 0 ? 1.0 : -1.0, 0.0})) << t_;
  }
}

// A turn on the spot takes longer than the patience.
TEST_F(Scouted, WhoTurnsIsNotGivenUp) {
  FirstLook();
  ASSERT_TRUE(look_);
  p_ = look_->p_WB;
  yaw_ = look_->yaw + M_PI;
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(Step()) << i;
}

TEST_F(Scouted, ALookEndsWhereItMayNot) {
  FirstLook();
  ASSERT_TRUE(look_);
  EXPECT_FALSE(Step(Eigen::Vector3d::Zero(), 1, false));
  EXPECT_FALSE(Step());
}

}  // namespace
}  // namespace touchdown::planning
