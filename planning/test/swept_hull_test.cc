// SPDX-License-Identifier: BSD-3-Clause
// The hull's tube through observed-free cells against the ball tested cell by cell.

#include "touchdown/planning/certify/swept_hull.h"

#include <gtest/gtest.h>

#include "planning/test/hull_fixtures.h"
#include "touchdown/planning/spline/rest_trajectory.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

UniformBspline RandomCurve(Draw* draw) {
  SplineState from = draw->State(0.0, 1.5, 3.0), to = draw->State(2.0, 1.0, 2.0);
  from.p.setZero();
  return Between(from, to, draw->Uniform(0.8, 3.0));
}

Sweep Look(const UniformBspline& curve, const HullSpace& hull) {
  return SweepHull(curve, curve.t0(), curve.t_end(), {curve.Position(curve.t0()), curve.t0()}, hull,
                   kAnyTime);
}

TEST(SweptHull, AgreesWithEveryCellOfEveryBall) {
  Draw draw(1);
  int proven = 0, refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const OccupancyMap map = RandomMap(&draw, 1 + trial % 5, kHull + 0.1);
    const FreeSpace space = SpaceOf(map);
    const UniformBspline curve = RandomCurve(&draw);
    const Sweep sweep = Look(curve, HullOf(space));
    const auto place = [&](double t) { return curve.Position(t); };
    const auto free = [&](double radius) {
      return TubeInFree(map, 0.0, curve.t_end(), radius, nullptr, 0.0, place);
    };
    if (sweep.proven) {
      EXPECT_FALSE(sweep.start.leaves());
      EXPECT_TRUE(free(kHull)) << trial;
    } else {
      // 2 mm of its larger ball are between two of these looks.
      EXPECT_FALSE(free(kHull + kHullRoom + 0.002)) << trial;
      ASSERT_TRUE(sweep.unseen_W.has_value());
      EXPECT_FALSE(map.IsObservedFree(map.CellOf(*sweep.unseen_W)));
    }
    (sweep.proven ? proven : refused) += 1;
  }
  EXPECT_GT(proven, 100);
  EXPECT_GT(refused, 100);
}

// However slowly and tightly the way turns, every cell that the hull reaches into is found.
TEST(SweptHull, TightTurnsAreSeen) {
  Draw draw(3);
  int looked = 0;
  for (int trial = 0; trial < 8000; ++trial) {
    SplineState from = draw.State(0.0, 0.6, 3.0), to = draw.State(0.3, 0.4, 2.0);
    from.p.setZero();
    UniformBspline curve = Between(from, to, draw.Uniform(0.3, 1.2));
    if (trial % 2 == 0) {  // a stop that climbs from a descent
      from.v = {draw.Uniform(0.0, 0.4), 0.0, draw.Uniform(-0.4, 0.0)};
      from.a.setZero();
      curve = MakeRestTrajectory(from, 0.0, {0.0, 0.0, 1.0}, {.speed = 3.0, .acceleration = 6.0});
    }
    OccupancyMap map(NoGround());
    map.MarkRestFree();
    const double t = draw.Uniform(0.0, 0.4) * curve.duration();
    const Eigen::Vector3d direction = draw.Vector(1.0).normalized();
    const CellIndex cell = map.CellOf(curve.Position(t) + (kHull + 0.04) * direction);
    double nearest = 10.0;
    for (double s = 0.0; s <= curve.duration(); s += 1e-3) {
      nearest = std::min(nearest, DistanceToCell(map, cell, curve.Position(s)));
    }
    const bool there_at_start = DistanceToCell(map, cell, from.p) < kHull + kHullRoom;
    if (there_at_start || nearest > kHull - 5e-4 || nearest < kHull - 0.03) continue;
    map.SetState(cell, CellState::kUnknown);
    const FreeSpace space = SpaceOf(map);
    EXPECT_FALSE(Look(curve, HullOf(space)).proven) << trial << ": " << kHull - nearest << " m";
    ++looked;
  }
  EXPECT_GT(looked, 200);
}

// From one sample to the next it may turn back: the farthest point counts too.
TEST(SweptHull, AWayThatTurnsBackIsSeenToItsEnd) {
  for (double reach = 0.01; reach < 0.2; reach += 0.005) {
    OccupancyMap map(NoGround());
    map.MarkRestFree();
    // Forth by about `reach` along x and back past the start.
    const SplineState from{{0, 0, 0}, {1.0, 0, 0}, {-0.5 / reach, 0, 0}};
    const SplineState to{{-1, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const UniformBspline curve = Between(from, to, 1.5);
    double farthest = 0.0;
    for (double t = 0.0; t < 1.5; t += 1e-3) {
      farthest = std::max(farthest, curve.Position(t).x());
    }
    // The wall's face is 5 mm nearer than the hull needs there.
    const FreeSpace space = SpaceOf(map);
    HullSpace hull = HullOf(space);
    const double face = 0.5;
    hull.hull_radius = face - farthest + 0.005;
    for (int y = -32; y < 32; ++y) {
      for (int z = -16; z < 16; ++z) map.SetState({5, y, z}, CellState::kUnknown);
    }
    EXPECT_FALSE(Look(curve, hull).proven) << "turns " << farthest << " m ahead";
    hull.hull_radius -= 0.016;
    EXPECT_TRUE(Look(curve, hull).proven) << "turns " << farthest << " m ahead";
  }
}

TEST(SweptHull, FromAmongUnseenCellsItMayOnlyLeave) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  ForEachCell({CellIndex(-6, -32, -16), CellIndex(-3, 32, 16)},
              [&](const CellIndex& cell) { map.SetState(cell, CellState::kUnknown); });
  const FreeSpace space =
      SpaceOf(map);  // unseen from x = -0.6 to -0.3 m, and the hull reaches to -0.4
  const auto go = [&](const Eigen::Vector3d& way) {
    return Look(Between({}, {way, {0, 0, 0}, {0, 0, 0}}, 2.0), HullOf(space));
  };
  const Sweep away = go({1.5, 0, 0});
  EXPECT_TRUE(away.proven);
  EXPECT_TRUE(away.start.unknown);
  EXPECT_FALSE(away.start.occupied);
  EXPECT_TRUE(go({0, 0, 0}).proven) << "nor does it have to move";
  EXPECT_FALSE(go({-0.05, 0, 0}).proven);
  // To the side it comes nearer to cells of the same wall.
  const Sweep along = go({0, 1.0, 0});
  EXPECT_FALSE(along.proven);
  EXPECT_TRUE(along.unseen_W.has_value());
  // With its centre in such a cell it proves nothing.
  const SplineState inside{{-0.45, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_FALSE(
      Look(Between(inside, {{1.5, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 2.0), HullOf(space)).proven);
}

TEST(SweptHull, WhereAProvenPairHasLedIsNoEscape) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  map.SetState(CellIndex(-3, 0, 0), CellState::kUnknown);
  const FreeSpace space = SpaceOf(map);
  HullSpace hull = HullOf(space);
  hull.start_proven = true;
  const UniformBspline away = Between({}, {{1.5, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 2.0);
  const Sweep leaves = Look(away, hull);
  EXPECT_TRUE(leaves.proven);
  EXPECT_FALSE(leaves.start.leaves());
  EXPECT_TRUE(leaves.start.narrow);
  // A hit is new, whatever was proven before.
  map.SetState(CellIndex(-3, 0, 0), CellState::kOccupied);
  EXPECT_TRUE(Look(away, hull).start.occupied);
}

// The same for a hull of no size: once it was tested only where it begins and ends.
TEST(SweptHull, APointDoesNotPassAWallEither) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  const FreeSpace space = SpaceOf(map);
  HullSpace point = HullOf(space);
  point.hull_radius = point.margin = 0.0;
  const UniformBspline through = Between({}, {{2.0, 0.0, 0.0}, {0, 0, 0}, {0, 0, 0}}, 2.0);
  EXPECT_TRUE(Look(through, point).proven);
  const CellIndex low = map.CellOf({1.0, -1.0, -1.0});
  ForEachCell({low, low + CellIndex(1, 20, 20)},
              [&](const CellIndex& cell) { map.SetState(cell, CellState::kOccupied); });
  EXPECT_FALSE(Look(through, point).proven);
}

TEST(SweptHull, LeavesOnlyWhatItReachedAlready) {
  Draw draw(3);
  int leaves = 0, refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const OccupancyMap map = RandomMap(&draw, 60, 0.25);
    const FreeSpace space = SpaceOf(map);
    const Eigen::Vector3d to = draw.Vector(0.5);
    const UniformBspline curve = Between({}, {to, {0, 0, 0}, {0, 0, 0}}, draw.Uniform(0.8, 2.0));
    const Sweep sweep = Look(curve, HullOf(space));
    if (!sweep.proven) {
      ++refused;
      continue;
    }
    leaves += sweep.start.leaves();
    const Eigen::Vector3d start = curve.Position(0.0);
    EXPECT_TRUE(TubeInFree(map, 0.0, curve.t_end(), kHull, &start, kHullRoom, [&](double t) {
      return curve.Position(t);
    })) << trial;
  }
  EXPECT_GT(leaves, 20);
  EXPECT_GT(refused, 100);
}

TEST(SweptHull, OutOfTheWindowNothingIsProven) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  const FreeSpace space = SpaceOf(map);
  const auto to = [&](double x) {
    return Look(Between({}, {{x, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 3.0), HullOf(space)).proven;
  };
  EXPECT_TRUE(to(2.7));
  EXPECT_FALSE(to(2.9));
}

TEST(SweptHull, GroundIsExceptedAndFloorAndCeilingAreKept) {
  OccupancyMap map(SmallMap(0.3));
  map.MarkRestFree();
  for (int x = -32; x < 32; ++x) {
    for (int y = -32; y < 32; ++y) {
      for (int z = -16; z < 1; ++z) map.SetState({x, y, z}, CellState::kUnknown);
    }
  }
  FreeSpace space = SpaceOf(map);
  const auto level = [&](double z) {
    const SplineState a{{-1, 0, z}, {0, 0, 0}, {0, 0, 0}}, b{{1, 0, z}, {0, 0, 0}, {0, 0, 0}};
    return Look(Between(a, b, 3.0), HullOf(space)).proven;
  };
  EXPECT_TRUE(level(0.45)) << "below 0.1 m all is ground";
  for (int x = -32; x < 32; ++x) map.SetState({x, 0, 1}, CellState::kUnknown);
  EXPECT_FALSE(level(0.45)) << "a cell that ends at 0.2 m is not";
  EXPECT_TRUE(level(0.65));
  space.floor = 0.7;
  space.ceiling = 1.0;
  const auto through = [&](double from, double z) {
    const SplineState a{{-1, 0, from}, {0, 0, 0}, {0, 0, 0}}, b{{1, 0, z}, {0, 0, 0}, {0, 0, 0}};
    return Look(Between(a, b, 3.0), HullOf(space)).proven;
  };
  EXPECT_FALSE(through(0.8, 0.695));
  EXPECT_TRUE(through(0.8, 0.7));
  EXPECT_TRUE(through(0.8, 1.0));
  EXPECT_FALSE(through(0.8, 1.005));
  EXPECT_TRUE(through(0.695, 0.75)) << "who starts beyond them only has to go no farther";
  EXPECT_FALSE(through(0.695, 0.69));
}

class DeckPad : public ArcPad {
 public:
  explicit DeckPad(double sigma) : ArcPad({0, 0, 0.45}, 0.0, 0.0, 0.0), sigma_(sigma) {}
  estimation::PadState At(double t) const noexcept override {
    estimation::PadState state = ArcPad::At(t);
    state.cov_p = Eigen::Vector2d(sigma_ * sigma_, 0.0).asDiagonal();
    return state;
  }

 private:
  double sigma_;
};

// Straight down on to a deck of 0.6 m, below and in whose upper face nothing was observed free.
class OverDeck : public ::testing::Test {
 protected:
  OverDeck() : map_(SmallMap(0.3)) {
    map_.MarkRestFree();
    ForEachCell({CellIndex(-3, -3, 0), CellIndex(3, 3, 5)},
                [&](const CellIndex& cell) { map_.SetState(cell, CellState::kUnknown); });
  }
  bool Lands(double x = 0.0, double sigma = 0.0) const {
    const DeckPad pad(sigma);
    const FreeSpace space = SpaceOf(map_);
    HullSpace hull = HullOf(space);
    hull.pad = &pad;
    hull.deck_half_size = 0.3;
    hull.foot_depth = 0.12;
    const SplineState above{{x, 0, 1.1}, {0, 0, 0}, {0, 0, 0}};
    const SplineState on{{x, 0, 0.57}, {0, 0, -0.2}, {0, 0, 0}};
    return Look(Between(above, on, 2.0), hull).proven;
  }
  OccupancyMap map_;
};

TEST_F(OverDeck, TheDeckIsExcepted) {
  EXPECT_TRUE(Lands());
  EXPECT_TRUE(Lands(0.25));
}

TEST_F(OverDeck, BesideTheDeckItIsNot) { EXPECT_FALSE(Lands(0.35)); }

TEST_F(OverDeck, WhereTheDeckMayNotBeItIsNot) {
  EXPECT_TRUE(Lands(0.0, 0.05));
  EXPECT_FALSE(Lands(0.2, 0.05)) << "3 sigma may leave 0.15 m of it";
  EXPECT_FALSE(Lands(0.0, 0.2)) << "3 sigma are more than all of it";
}

TEST_F(OverDeck, APostBesideItForbidsOnlyAboveItsTop) {
  // Its top is the deck's, in the cell from 0.4 to 0.5 m. What reaches no higher than the deck is
  // harmless, what fills the next cell is not.
  map_.SetState({3, 0, 3}, CellState::kOccupied);
  EXPECT_TRUE(Lands());
  map_.SetState({3, 0, 5}, CellState::kOccupied);
  EXPECT_FALSE(Lands());
}

TEST_F(OverDeck, WhatStandsOnItForbids) {
  map_.SetState({0, 0, 5}, CellState::kOccupied);
  EXPECT_FALSE(Lands());
}

// A vehicle that rises while the deck drives on only leaves cells of the deck's old place.
TEST_F(OverDeck, WhereTheDeckWasIsNothingElse) {
  const ArcPad drives({0, 0, 0.45}, 0.8, 0.0, 0.0);
  const FreeSpace space = SpaceOf(map_);
  HullSpace hull = HullOf(space);
  hull.pad = &drives;
  hull.deck_half_size = 0.3;
  hull.foot_depth = 0.12;
  const SplineState low{{0, 0, 0.62}, {0, 0, 0}, {0, 0, 0}};
  const SplineState high{{0, 0, 1.1}, {0, 0, 0}, {0, 0, 0}};
  const Sweep rises = Look(Between(low, high, 2.0), hull);
  EXPECT_TRUE(rises.proven);
  EXPECT_FALSE(rises.start.leaves());
  map_.SetState({1, 1, 4}, CellState::kOccupied);  // what blocks there does not belong to it
  const Sweep beside = Look(Between(low, high, 2.0), hull);
  EXPECT_TRUE(beside.start.occupied);
  EXPECT_FALSE(beside.start.unknown);
}

// For a way that was proven before, cells not seen any more do not matter, not even before what
// blocks.
TEST(SweptHull, WhereUnseenPassesOnlyTheOccupiedBlocks) {
  OccupancyMap map(NoGround());
  const FreeSpace space = SpaceOf(map);
  HullSpace hull = HullOf(space);
  const UniformBspline curve =
      Between({{-1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 3.0);
  EXPECT_FALSE(Look(curve, hull).proven);
  hull.unseen_passes = true;
  EXPECT_TRUE(Look(curve, hull).proven);
  map.SetState({8, 0, 0}, CellState::kOccupied);
  const Sweep sweep = Look(curve, hull);
  EXPECT_FALSE(sweep.proven);
  ASSERT_TRUE(sweep.unseen_W.has_value());
  EXPECT_TRUE(map.IsOccupied(map.CellOf(*sweep.unseen_W)));
}

TEST_F(OverDeck, AirAboveItHasToBeSeen) {
  map_.SetState({1, 1, 5}, CellState::kUnknown);
  EXPECT_FALSE(Lands());
}

TEST(SweptHull, DoesNotAllocate) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  Draw draw(5);
  const OccupancyMap map = RandomMap(&draw, 2, 0.6);
  const FreeSpace space = SpaceOf(map);
  const DeckPad pad(0.02);
  HullSpace hull = HullOf(space);
  hull.pad = &pad;
  hull.deck_half_size = 0.5;
  for (int trial = 0; trial < 20; ++trial) {
    const UniformBspline curve = RandomCurve(&draw);
    const long before = solvers::AllocationCount();
    Look(curve, hull);
    EXPECT_EQ(solvers::AllocationCount(), before);
  }
}

}  // namespace
}  // namespace touchdown::planning
