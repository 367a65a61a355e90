// SPDX-License-Identifier: BSD-3-Clause
// The pair of a curve and its stored stop: what is proven is what is flown. Tested over random maps, with answers
// that are lost, late and refused.

#include "touchdown/planning/certify/stored_stop.h"

#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "planning/certify/pad_strip.h"
#include "planning/test/hull_fixtures.h"
#include "planning/test/replanner_fixtures.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

const Limits kLimits{3.0, 6.0};

/// A curve from `from`, at t = 0, to anywhere.
FlightPair PairFrom(const SplineState& from, const Eigen::Vector3d& to, double duration) {
  FlightPair pair;
  pair.curve = Between(from, {to, {0, 0, 0}, {0, 0, 0}}, duration);
  return pair;
}

double RestOf(const FlightPair& pair) {
  return std::isfinite(pair.t_stop) ? pair.stop.t_end() : pair.curve.t_end();
}

TEST(StoredStop, NoProvenPairMeetsWhatIsNotObservedFree) {
  Draw draw(1);
  int proven = 0, leaves = 0, refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    // Among unseen cells hardly anything fast is proven.
    const bool among_unseen = trial % 2 == 0;
    const OccupancyMap map =
        RandomMap(&draw, among_unseen ? 60 : 1 + trial % 30, among_unseen ? 0.3 : kHull + 0.1);
    const FreeSpace space = SpaceOf(map);
    SplineState from = draw.State(0.0, among_unseen ? 0.02 : 1.4, among_unseen ? 0.0 : 3.0);
    from.p.setZero();
    const Eigen::Vector3d to = draw.Vector(among_unseen ? 1.0 : 2.0);
    FlightPair pair = PairFrom(from, to, draw.Uniform(0.8, 3.0));
    const double t_from = draw.Uniform(0.0, 0.3), t_handover = t_from + draw.Uniform(0.0, 0.5);
    const Eigen::Vector3d start = pair.curve.Position(t_from);
    const PairProof proof =
        ProvePair(t_from, t_handover, PairEnd::kRest, kLimits, HullOf(space), &pair);
    if (!proof.proven) {
      ++refused;
      EXPECT_TRUE(proof.unseen_W.has_value()) << trial;
      continue;
    }
    ++proven;
    leaves += proof.start.leaves();
    EXPECT_FALSE(proof.contact);
    EXPECT_EQ(pair.t_stop, t_handover);
    // Curve and stop are one trajectory: no jump in position, velocity or acceleration.
    const FlatState before = pair.curve.EvaluateOnward(t_handover), after = pair.At(t_handover);
    EXPECT_LT((before.p_WB - after.p_WB).norm(), 1e-9);
    EXPECT_LT((before.v_WB - after.v_WB).norm(), 1e-9);
    EXPECT_LT((before.a_WB - after.a_WB).norm(), 1e-8);
    EXPECT_LT(pair.At(pair.stop.t_end() + 5.0).v_WB.norm(), 1e-9) << "it stays at rest";
    const auto place = [&](double t) { return pair.At(t).p_WB; };
    EXPECT_TRUE(TubeInFree(map, t_from, RestOf(pair) + 0.5, kHull,
                           proof.start.leaves() ? &start : nullptr, kHullRoom, place))
        << trial;
  }
  EXPECT_GT(proven, 100);
  EXPECT_GT(leaves, 10);
  EXPECT_GT(refused, 100);
}

TEST(StoredStop, ACurveThatEndsAtRestIsItsOwnStop) {
  Draw draw(2);
  int proven = 0, refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const OccupancyMap map = RandomMap(&draw, 1 + trial % 12, kHull + 0.1);
    const FreeSpace space = SpaceOf(map);
    const Eigen::Vector3d to = draw.Vector(1.8);
    FlightPair pair = PairFrom({}, to, draw.Uniform(1.0, 2.5));
    const PairProof proof = ProveStop(0.0, HullOf(space), &pair);
    EXPECT_EQ(pair.t_stop, std::numeric_limits<double>::infinity());
    const bool free = TubeInFree(map, 0.0, pair.curve.t_end() + 1.0, kHull, nullptr, 0.0,
                                 [&](double t) { return pair.At(t).p_WB; });
    if (proof.proven) {
      EXPECT_TRUE(free) << trial;
    }
    (proof.proven ? proven : refused) += 1;
  }
  EXPECT_GT(proven, 30);
  EXPECT_GT(refused, 30);
}

/// Flying along x at 2.5 m/s and still speeding up with 3 m/s^2 when the stop begins.
FlightPair Fast(double t0 = 0.0) {
  const SplineState fast{{-1, 0, 0}, {2.5, 0, 0}, {3.0, 0, 0}};
  FlightPair pair;
  pair.curve = Between(fast, {{2, 0, 0}, {2.5, 0, 0}, {0, 0, 0}}, 1.1, t0);
  return pair;
}

// Before, v^2 / (1.2 a) = 0.87 m of the curve were certified, and 1.17 m off it flown.
TEST(StoredStop, WhatIsCertifiedIsAsLongAsWhatIsFlown) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  const FreeSpace space = SpaceOf(map);
  const auto wall_at = [&](double ahead, CellState state) {
    const int x = static_cast<int>(std::lround((-1.0 + ahead) / map.resolution()));
    for (int y = -32; y < 32; ++y) {
      for (int z = -16; z < 16; ++z) map.SetState({x, y, z}, state);
    }
  };
  FlightPair pair = Fast();
  ASSERT_TRUE(ProvePair(0.0, 0.0, PairEnd::kRest, kLimits, HullOf(space), &pair).proven);
  const double flown = pair.stop.Position(pair.stop.t_end()).x() + 1.0;
  EXPECT_GT(flown, 0.87 + 0.2);
  EXPECT_LT(flown, 1.4);
  // A wall that the formula's stop does not touch, and the one that is flown does.
  const double face = 0.1 * std::floor(10.0 * (flown + kHull));
  ASSERT_GT(face, 0.87 + kHull + kHullRoom);
  wall_at(face, CellState::kUnknown);
  EXPECT_FALSE(ProvePair(0.0, 0.0, PairEnd::kRest, kLimits, HullOf(space), &pair).proven);
  wall_at(face, CellState::kFree);
  wall_at(face + 0.2, CellState::kUnknown);
  EXPECT_TRUE(ProvePair(0.0, 0.0, PairEnd::kRest, kLimits, HullOf(space), &pair).proven);
}

TEST(StoredStop, LessAccelerationNeedsALongerStop) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  const FreeSpace space = SpaceOf(map);
  const auto length = [&](const Limits& limits) {
    SplineState from{{-2.0, 0, 0}, {2.0, 0, 0}, {0, 0, 0}};
    FlightPair pair = PairFrom(from, {1, 0, 0}, 3.0);
    EXPECT_TRUE(ProvePair(0.0, 0.0, PairEnd::kRest, limits, HullOf(space), &pair).proven);
    EXPECT_LE(BoundDerivatives(pair.stop).acceleration,
              limits.acceleration * limits.braking_factor + 1e-6);
    return (pair.stop.Position(pair.stop.t_end()) - from.p).norm();
  };
  EXPECT_GT(length({3.0, 2.0}), 2.0 * length({3.0, 6.0}));
  EXPECT_LT(length({3.0, 2.0, 2.5}), length({3.0, 2.0})) << "the tracking law tilts farther";
}

/// Over a deck of 1 m that stands at the origin, its top at 0.45 m.
class StopOverDeck : public ::testing::Test {
 protected:
  StopOverDeck() : map_(SmallMap(0.3)), pad_({0, 0, 0.45}, 0.0, 0.0, 0.0) {
    map_.MarkRestFree();
    ForEachCell({CellIndex(-5, -5, 0), CellIndex(5, 5, 5)},
                [&](const CellIndex& cell) { map_.SetState(cell, CellState::kUnknown); });
    space_ = SpaceOf(map_);
    space_.pad_radius = 1.2;
    space_.pad_floor = 0.45;  // a landing presses on past contact
    hull_ = HullOf(space_);
    hull_.pad = &pad_;
    hull_.deck_half_size = 0.5;
    hull_.foot_depth = 0.12;
  }
  /// Sinking over the deck with `rate`, `height` of the feet above it.
  PairProof Prove(double height, double rate, PairEnd ends, FlightPair* pair) const {
    const double z = 0.45 + 0.12 + height;
    const SplineState from{{0, 0, z}, {0, 0, -rate}, {0, 0, 0}};
    pair->curve = Between(from, {{0, 0, 0.60}, {0, 0, -0.2}, {0, 0, 0}}, 0.5 + height);
    return ProvePair(0.0, 0.1, ends, kLimits, hull_, pair);
  }
  OccupancyMap map_;
  ArcPad pad_;
  FreeSpace space_;
  HullSpace hull_;
};

TEST_F(StopOverDeck, NoStopRestsInThePadsWay) {
  FlightPair pair;
  for (const double height : {0.6, 0.4, 0.3, 0.1}) {
    const PairProof proof = Prove(height, 0.5, PairEnd::kRest, &pair);
    ASSERT_TRUE(proof.proven) << height;
    const double feet = pair.stop.Position(pair.stop.t_end()).z() - 0.12 - 0.45;
    EXPECT_GE(feet, 0.1 - 1e-6) << "it climbs clear of the deck instead, from " << height << " m";
    EXPECT_FALSE(proof.contact);
  }
}

TEST_F(StopOverDeck, WhereItCannotClimbALandingGoesOnToContact) {
  // A roof that was never seen, closely above the hull.
  for (int x = -32; x < 32; ++x) {
    for (int y = -32; y < 32; ++y) map_.SetState({x, y, 11}, CellState::kUnknown);
  }
  FlightPair pair;
  EXPECT_FALSE(Prove(0.1, 0.4, PairEnd::kRest, &pair).proven);
  const PairProof lands = Prove(0.1, 0.4, PairEnd::kRestOrContact, &pair);
  EXPECT_TRUE(lands.proven);
  EXPECT_TRUE(lands.contact);
  EXPECT_EQ(pair.t_stop, std::numeric_limits<double>::infinity());
  // Not past a post beside the deck that stands 0.1 m above its top; one as high as the deck is allowed.
  map_.SetState({5, 0, 3}, CellState::kOccupied);
  EXPECT_FALSE(Prove(0.1, 0.4, PairEnd::kRest, &pair).proven);
  hull_.deck_half_size = 0.3;  // so that the hull's ball reaches beside it
  ForEachCell({CellIndex(-5, -5, 0), CellIndex(5, 5, 5)}, [&](const CellIndex& cell) {
    const Eigen::Vector3d p = map_.CentreOf(cell);
    if (p.head<2>().cwiseAbs().maxCoeff() > 0.3) map_.SetState(cell, CellState::kFree);
  });
  ASSERT_TRUE(Prove(0.1, 0.4, PairEnd::kRestOrContact, &pair).proven);
  map_.SetState({3, 0, 5}, CellState::kOccupied);
  EXPECT_FALSE(Prove(0.1, 0.4, PairEnd::kRestOrContact, &pair).proven);
}

TEST_F(StopOverDeck, ALandingThatMissesTheDeckIsNone) {
  FlightPair pair;
  ASSERT_TRUE(Prove(0.1, 0.4, PairEnd::kContact, &pair).contact);
  ASSERT_TRUE(pair.Lands());
  EXPECT_LT(ContactTime(pair.curve, 0.0, hull_), pair.curve.t_end() + 1.5);
  const ArcPad gone({0.6, 0, 0.45}, 0.0, 0.0, 0.0);
  hull_.pad = &gone;
  EXPECT_EQ(ContactTime(pair.curve, 0.0, hull_), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(Prove(0.1, 0.4, PairEnd::kContact, &pair).proven);
  hull_.pad = nullptr;
  EXPECT_EQ(ContactTime(pair.curve, 0.0, hull_), std::numeric_limits<double>::infinity());
}

// The same way on to a deck that drives off below it or rises to meet it is no touchdown.
TEST_F(StopOverDeck, ContactThatIsNotSoftIsNone) {
  FlightPair pair;
  ASSERT_TRUE(Prove(0.1, 0.4, PairEnd::kContact, &pair).contact);
  const double t = ContactTime(pair.curve, 0.0, hull_);
  EXPECT_TRUE(TouchesSoftly(pair.curve, t, 0.9, hull_));
  map_.MarkRestFree();  // so that softness alone decides
  for (const auto& [speed, share, soft] :
       {std::tuple(0.5, 0.9, true), std::tuple(0.57, 1.0, true), std::tuple(0.57, 0.9, false),
        std::tuple(0.63, 1.0, false)}) {
    const ArcPad drives(Eigen::Vector3d(-speed * t, 0, 0.45), speed, 0.0, 0.0);
    hull_.pad = &drives;
    EXPECT_TRUE(std::isfinite(ContactTime(pair.curve, 0.0, hull_))) << "it is below by then";
    EXPECT_EQ(TouchesSoftly(pair.curve, t, share, hull_), soft) << speed;
    if (share == 0.9) {
      EXPECT_EQ(Prove(0.1, 0.4, PairEnd::kContact, &pair).proven, soft) << speed;
    }
  }
}

// A deck that drives up is seen as free space: cells alone do not forbid to pass through its edge.
TEST_F(StopOverDeck, ALandingMeetsTheDeckOnlyWhereItIsToTouchIt) {
  map_.MarkRestFree();
  const SplineState end{{0, 0, 0.60}, {0, 0, -0.3}, {0, 0, 0}};
  FlightPair pair;
  const auto lands = [&](double dip) {
    pair.curve = Between({{-0.7, 0, 0.8}, {0.8, 0, -dip}, {0, 0, 0}}, end, 0.8);
    return ProvePair(0.0, 0.1, PairEnd::kRestOrContact, kLimits, hull_, &pair).contact;
  };
  const auto lowest_feet = [&] {
    double feet = 1.0;
    for (double t = 0.0; t < 0.7; t += 0.01)
      feet = std::min(feet, pair.curve.Position(t).z() - 0.12);
    return feet - 0.45;
  };
  EXPECT_TRUE(lands(0.3));
  EXPECT_GT(lowest_feet(), 0.02);
  EXPECT_FALSE(lands(1.5));
  EXPECT_LT(lowest_feet(), -0.03);
  const double later = ContactTime(pair.curve, 0.0, hull_);
  EXPECT_GT(later, 0.8);
  ASSERT_TRUE(std::isfinite(later));
  EXPECT_TRUE(TouchesSoftly(pair.curve, later, 0.9, hull_));
  const HullStart start{pair.curve.Position(0.0), 0.0};
  EXPECT_TRUE(SweepHull(pair.curve, 0.0, later, start, hull_, kAnyTime).proven)
      << "cells alone allow it";
}

// A vehicle that brakes leans, and its foot would touch a deck that drives on below.
TEST_F(StopOverDeck, CloseOverADeckThatDrivesOffNothingRests) {
  map_.MarkRestFree();
  const auto rests = [&](double feet, double speed) {
    const ArcPad drives({0, 0, 0.45}, speed, 0.0, 0.0);
    hull_.pad = &drives;
    const UniformBspline stop = Between({{0, 0, 0.87}, {0.8, 0, -0.3}, {0, 0, 0}},
                                        {{0.3, 0, 0.57 + feet}, {0, 0, 0}, {0, 0, 0}}, 0.8);
    return SweepHull(stop, 0.0, 0.8, {{0, 0, 0.87}, 0.0}, hull_, kNever).proven;
  };
  EXPECT_TRUE(rests(0.06, 0.8));
  EXPECT_FALSE(rests(0.04, 0.8));
  EXPECT_TRUE(rests(0.04, 0.4));
}

// The second half of a landing begins close over the deck: there the vehicle drives as the deck does.
TEST_F(StopOverDeck, ALandingThatFollowsTheDeckGoesOnCloseOverIt) {
  map_.MarkRestFree();
  const ArcPad drives({0, 0, 0.45}, 0.8, 0.0, 0.0);
  hull_.pad = &drives;
  const auto lands = [&](double speed) {
    FlightPair pair;
    pair.curve = Between({{0, 0, 0.67}, {speed, 0, -0.2}, {0, 0, 0}},
                         {{0.5 * speed, 0, 0.57}, {speed, 0, -0.2}, {0, 0, 0}}, 0.5);
    return ProvePair(0.0, 0.35, PairEnd::kContact, kLimits, hull_, &pair).contact;
  };
  EXPECT_TRUE(lands(0.8));
  EXPECT_FALSE(lands(0.0));
}

// A leaning vehicle's foot touches early: no plan may dive close to the deck and level there.
TEST_F(StopOverDeck, CloseOverTheDeckNothingSinksFasterThanItMayTouch) {
  map_.MarkRestFree();
  Draw draw(8);
  int dives = 0, lands = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const SplineState from{
        {0, 0, 0.57 + draw.Uniform(0.15, 0.5)}, {0, 0, -draw.Uniform(0.0, 1.5)}, {0, 0, 0}};
    const SplineState end{{0, 0, 0.57 + draw.Uniform(0.01, 0.1)}, {0, 0, -0.2}, {0, 0, 0}};
    FlightPair pair;
    pair.curve = Between(from, end, draw.Uniform(0.3, 1.2));
    const double t_contact = ContactTime(pair.curve, 0.0, hull_);
    bool dives_low = false;
    for (double t = 0.0; t < std::min(t_contact, pair.curve.t_end()) - 0.01; t += 0.01) {
      const FlatState at = pair.curve.Evaluate(t);
      dives_low |= at.p_WB.z() - 0.57 < 0.045 && at.v_WB.z() < -0.47;
    }
    const bool contact = ProvePair(0.0, 0.1, PairEnd::kContact, kLimits, hull_, &pair).contact;
    EXPECT_FALSE(contact && dives_low) << trial;
    const HullStart start{from.p, 0.0};
    const bool stops = SweepHull(pair.curve, 0.0, pair.curve.t_end(), start, hull_, kNever).proven;
    EXPECT_FALSE(stops && dives_low) << trial;
    dives += dives_low ? 1 : 0;
    lands += contact ? 1 : 0;
  }
  EXPECT_GT(dives, 20);
  EXPECT_GT(lands, 50);
  // A vehicle that is there already and still too fast may brake.
  const SplineState low{{0, 0, 0.61}, {0, 0, -0.6}, {0, 0, 2.0}};
  const UniformBspline brakes = Between(low, {{0, 0, 0.59}, {0, 0, 0}, {0, 0, 0}}, 0.15);
  EXPECT_TRUE(SweepHull(brakes, 0.0, 0.15, {low.p, 0.0}, hull_, kNever).proven);
}

TEST_F(StopOverDeck, WhereItIsToLandNoStopIsAnAnswer) {
  map_.SetState({3, 0, 5}, CellState::kOccupied);
  FlightPair pair;
  EXPECT_TRUE(Prove(0.6, 0.3, PairEnd::kRestOrContact, &pair).proven) << "it stops above";
  EXPECT_FALSE(pair.Lands());
  EXPECT_FALSE(Prove(0.6, 0.3, PairEnd::kContact, &pair).proven);
}

// What a ray met on the deck or by its noise just above is the deck; what was seen there to block is not.
TEST_F(StopOverDeck, WhereItsReturnsLieCellsMayBeUnknownNotOccupied) {
  FlightPair pair;
  for (const double noise : {0.0, 0.02}) {
    OccupancyMapOptions options = map_.options();
    options.range_noise = noise;
    OccupancyMap map(options);
    map.MarkRestFree();
    for (int x = -5; x < 5; ++x) {
      for (int y = -5; y < 5; ++y) map.SetState({x, y, 5}, CellState::kUnknown);
    }
    space_.map = &map;
    EXPECT_EQ(Prove(0.1, 0.4, PairEnd::kContact, &pair).proven, noise > 0.0);
    map.SetState({2, 0, 5}, CellState::kOccupied);
    EXPECT_FALSE(Prove(0.1, 0.4, PairEnd::kContact, &pair).proven);
  }
}

// As the pilot requests it: the feet meet the deck 0.15 s after the plan's end, sinking with 0.3 m/s.
TEST_F(StopOverDeck, TheStripLeavesRoomToPressUntilContact) {
  for (int x = -32; x < 32; ++x) {
    for (int y = -32; y < 32; ++y) map_.SetState({x, y, 11}, CellState::kUnknown);
  }
  EndpointTarget target;
  target.height = target.height_floor = 0.12 + 0.045;
  target.arrival_sink = 0.3;
  const SplineState from{{0, 0, 0.68}, {0, 0, -0.3}, {0, 0, 0}};
  const SplineState to = EndStateAt(pad_, target, 0.3).state;
  LayPadStrip(pad_, target, from.p, 0.0, 0.3, 1.2, 0.12, &space_);
  FlightPair pair;
  pair.curve = Between(from, to, 0.3);
  const PairProof proof = ProvePair(0.0, 0.1, PairEnd::kRestOrContact, kLimits, hull_, &pair);
  EXPECT_TRUE(proof.proven);
  EXPECT_TRUE(proof.contact);
}

TEST(StoredStop, ProvingDoesNotAllocate) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  Draw draw(5);
  const OccupancyMap map = RandomMap(&draw, 3, 0.6);
  const FreeSpace space = SpaceOf(map);
  FlightPair pair = PairFrom({}, {1, 0, 0}, 2.0);
  pair.stop.Reserve(32);
  const ControlPoints points =
      HermiteControlPoints({}, {draw.Vector(1.5), {0, 0, 0}, {0, 0, 0}}, 12, 2.0);
  for (int trial = 0; trial < 20; ++trial) {
    pair.curve.Assign(points, draw.Uniform(0.08, 0.2), 0.0);
    const long before = solvers::AllocationCount();
    ProvePair(0.0, 0.3, trial % 2 == 0 ? PairEnd::kRest : PairEnd::kRestOrContact, kLimits,
              HullOf(space), &pair);
    ProveStop(0.0, HullOf(space), &pair);
    EXPECT_EQ(solvers::AllocationCount(), before);
  }
}

// With the replanner: the pair in force is what Reference gives.

void ExpectFlown(const Replanner& replanner, const FlightPair& pair, double from, double to) {
  for (double t = from; t <= to; t += 0.01) {
    EXPECT_EQ(replanner.Reference(t).p_WB, pair.At(t).p_WB) << t;
    EXPECT_EQ(replanner.Reference(t).v_WB, pair.At(t).v_WB) << t;
  }
}

TEST(StoredStop, TheCertifiedStopIsFlownWhereNoNewerPlanComes) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  const FreeSpace space = SpaceOf(map);
  FlightPair pair = Fast();
  ASSERT_TRUE(ProvePair(0.0, 0.0, PairEnd::kRest, kLimits, HullOf(space), &pair).proven);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  ReplannerState state;
  state.current = state.next = pair;
  state.planned = true;
  replanner.Restore(state);
  // Every request is refused: nothing is decided, and the vehicle stands where the pair ends.
  for (int step = 1; step < 30; ++step) {
    const double t = 0.05 * step;
    ReplanInput input;
    input.t_now = t;
    input.t_start = t + 0.02;
    input.vehicle.p_WB.setConstant(std::numeric_limits<double>::quiet_NaN());
    const ReplanResult& result = replanner.Replan(input, map);
    EXPECT_EQ(result.reason, ReplanReason::kInvalidInput);
    EXPECT_TRUE(result.proven && result.certificate.stops_in_observed_space);
  }
  ExpectFlown(replanner, pair, 0.0, 3.0);
  const FlatState rest = replanner.Reference(10.0);
  EXPECT_EQ(rest.p_WB, pair.stop.Position(pair.stop.t_end()));
  EXPECT_LT(rest.v_WB.norm(), 1e-9);
}

bool Same(const FlightPair& a, const FlightPair& b) {
  const auto same = [](const UniformBspline& c, const UniformBspline& d) {
    return c.t0() == d.t0() && c.interval() == d.interval() &&
           c.control_points().cols() == d.control_points().cols() &&
           c.control_points() == d.control_points();
  };
  return a.t_stop == b.t_stop && same(a.curve, b.curve) && same(a.stop, b.stop);
}

class InFlight : public ::testing::Test {
 protected:
  InFlight()
      : map_(ObservedMap()),
        pad_({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0),
        replanner_(Options(ArrivalMode::kFixed), solvers::StandardBackends()) {
    replanner_.CommitHover({-4.0, 0.0, 1.5}, 0.0);
    for (int step = 0; step <= 10; ++step) EXPECT_EQ(Ask(0.1 * step), ReplanStatus::kPlanned);
  }
  ReplanStatus Ask(double t) {
    const FlatState at = replanner_.Reference(t);
    ReplanInput input = Input(at.p_WB, pad_, t);
    input.vehicle.v_WB = at.v_WB;
    result_ = &replanner_.Replan(input, map_);
    return result_->status;
  }
  OccupancyMap map_;
  ArcPad pad_;
  Replanner replanner_;
  const ReplanResult* result_ = nullptr;
};

TEST_F(InFlight, AnAnswerThatComesAfterTheStopHasBegunIsDropped) {
  const FlightPair before = replanner_.state().next;
  ASSERT_TRUE(std::isfinite(before.t_stop));
  ASSERT_EQ(Ask(1.1), ReplanStatus::kPlanned);
  replanner_.TakeOverAt(before.t_stop + 0.05);
  // The result now is what is flown.
  EXPECT_FALSE(result_->committed);
  EXPECT_EQ(result_->status, ReplanStatus::kBraking);
  EXPECT_EQ(result_->curve.control_points(), before.stop.control_points());
  EXPECT_TRUE(result_->proven);
  ExpectFlown(replanner_, before, 1.05, 4.0);
  // The next step starts from the stop that is flown, and goes on.
  EXPECT_EQ(Ask(1.4), ReplanStatus::kPlanned);
  ExpectFlown(replanner_, before, 1.3, 1.41);
}

TEST_F(InFlight, AnAnswerThatIsLateButBeforeTheStopTakesOver) {
  const FlightPair before = replanner_.state().next;
  ASSERT_EQ(Ask(1.1), ReplanStatus::kPlanned);
  const FlightPair after = replanner_.state().next;
  const double late = before.t_stop - 0.01;
  replanner_.TakeOverAt(late);
  ExpectFlown(replanner_, before, 1.05, late - 1e-6);
  ExpectFlown(replanner_, after, late, 3.0);
}

TEST_F(InFlight, WithoutAnswersItStands) {
  const FlightPair last = replanner_.state().next;
  ExpectFlown(replanner_, last, 1.02, 6.0);
  EXPECT_LT(replanner_.Reference(6.0).v_WB.norm(), 1e-9);
}

TEST_F(InFlight, InvalidInputChangesNothing) {
  const FlightPair last = replanner_.state().next;
  ReplanInput input = Input({0, 0, 1.5}, pad_, 1.1);
  input.vehicle.v_WB.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(replanner_.Replan(input, map_).reason, ReplanReason::kInvalidInput);
  input = Input({0, 0, 1.5}, pad_, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(replanner_.Rest(input, 0.0, map_).reason, ReplanReason::kInvalidInput);
  ExpectFlown(replanner_, last, 1.02, 4.0);
}

/// A pair that was committed, and what was known when it was.
struct Committed {
  double t;
  Eigen::Vector3d start;
  OccupancyMap map;
  bool narrow;
};

// The safety claim, whatever the map and whichever answers get lost. The hull of what is flown stays in cells that
// were observed free when the pair in force was committed.
TEST(StoredStop, TheReferencesHullStaysInWhatWasObservedFree) {
  Draw draw(7);
  int plans = 0, kept = 0, stops = 0, dropped = 0;
  for (int trial = 0; trial < 120; ++trial) {  // seldom is one kept without a plan
    OccupancyMapOptions options = NoGround();
    options.size_log2 = {7, 6, 5};
    OccupancyMap map = RandomMap(&draw, 60, 100.0, options);
    map.Recentre({0, 0, 0});
    const Eigen::Vector3d start(-4.5, draw.Uniform(-1, 1), 0.3);
    for (int i = 0; i < 40; ++i) {
      const CellIndex low =
          map.CellOf({draw.Uniform(-3.5, 5), draw.Uniform(-3, 3), draw.Uniform(-1.6, 1.6)});
      const CellIndex side = (draw.Vector(3.0).array() + 4.1).matrix().cast<int>();
      const CellState state = draw.Uniform(0, 1) < 0.6 ? CellState::kUnknown : CellState::kOccupied;
      ForEachCell({low, low + side}, [&](const CellIndex& cell) { map.SetState(cell, state); });
    }
    ReplannerOptions asked = Options(trial % 2 == 0 ? ArrivalMode::kFixed : ArrivalMode::kFree);
    asked.floor_height = -1.4;
    asked.ceiling_height = 1.4;
    asked.limits.speed = draw.Uniform(1.0, 3.5);
    asked.limits.acceleration = draw.Uniform(2.0, 7.0);
    Replanner replanner(asked, solvers::StandardBackends());
    const ArcPad pad{{4.0, draw.Uniform(-1.5, 1.5), -1.0},
                     draw.Uniform(0.0, 0.6),
                     draw.Uniform(-3, 3),
                     draw.Uniform(-0.3, 0.3)};
    replanner.CommitHover(start, 0.0);
    std::vector<Committed> pairs;
    pairs.push_back({-1.0, start, map, true});
    double t = 0.0;
    for (int step = 0; step < 60; ++step) {
      const double next_t = t + draw.Uniform(0.05, 0.13);
      // Boxes come into sight, or turn out to be obstacles.
      if (step % 5 == 4) {
        const CellIndex low = map.CellOf(
            Eigen::Vector3d{draw.Uniform(-4, 4), draw.Uniform(-2, 2), draw.Uniform(-1.2, 1.2)});
        const CellState state = draw.Uniform(0, 1) < 0.8 ? CellState::kFree : CellState::kOccupied;
        ForEachCell({low, low + CellIndex(6, 6, 6)},
                    [&](const CellIndex& cell) { map.SetState(cell, state); });
      }
      const double luck = draw.Uniform(0, 1);
      if (luck > 0.2) {  // else there is no request
        const FlatState at = replanner.Reference(t);
        ReplanInput input = Input(at.p_WB, pad, t);
        input.vehicle.v_WB = at.v_WB;
        input.endpoint = {t, 0.6, 0.0, 0.6};
        if (luck < 0.3) input.vehicle.p_WB.x() = std::numeric_limits<double>::quiet_NaN();
        const FlightPair before = replanner.state().next;
        const Eigen::Vector3d start_W = replanner.Reference(input.t_start).p_WB;
        const ReplanResult& result =
            luck < 0.35 ? replanner.Rest(input, 0.0, map) : replanner.Replan(input, map);
        EXPECT_TRUE(result.proven && result.certificate.stops_in_observed_space);
        plans += result.status == ReplanStatus::kPlanned;
        kept += result.status == ReplanStatus::kKept;
        stops += result.status == ReplanStatus::kBraking;
        const bool is_new = !Same(replanner.state().next, before);
        double takes_over = input.t_start;
        if (draw.Uniform(0, 1) < 0.2) {
          takes_over += draw.Uniform(0.0, 0.3);
          replanner.TakeOverAt(takes_over);
        }
        if (is_new && !Same(replanner.state().next, before)) {
          pairs.push_back({takes_over, start_W, map, result.certificate.start_cells.narrow});
        } else if (is_new) {
          ++dropped;
        }
      }
      std::size_t in_force = pairs.size() - 1;
      for (double now = t; now < next_t; now += 5e-3) {
        in_force = pairs.size() - 1;
        while (pairs[in_force].t > now) --in_force;
        const Committed& pair = pairs[in_force];
        ASSERT_TRUE(BallInFree(pair.map, replanner.Reference(now).p_WB,
                               asked.hull_radius + Margins().Sum(),
                               pair.narrow ? &pair.start : nullptr, kHullRoom))
            << "trial " << trial << " at " << now;
      }
      pairs.erase(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(in_force));
      t = next_t;
    }
  }
  EXPECT_GT(plans, 1000);
  EXPECT_GT(kept, 3);
  EXPECT_GT(stops, 200);
  EXPECT_GT(dropped, 100);
}

}  // namespace
}  // namespace touchdown::planning
