// SPDX-License-Identifier: BSD-3-Clause
// Each part of the certificate, proven and refused.

#include "touchdown/planning/certify/certificate.h"

#include <gtest/gtest.h>

#include "planning/test/small_map.h"
#include "touchdown/planning/spline/boundary_lift.h"

namespace touchdown::planning {
namespace {

/// All that Certify itself proves; the pair's proof is separate.
bool Proven(Certificate certificate) {
  certificate.stops_in_observed_space = true;
  return certificate.passed();
}

TEST(Certificate, ProvesOrNamesEachPart) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkFree(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}, end{{2, 0, 0}, {0.5, 0, 0}, {0, 0, 0}};
  const UniformBspline curve(HermiteControlPoints(start, end, 12, 4.0), 4.0 / 12, 0.0);
  EXPECT_TRUE(Proven(Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, space)));
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &end, {1.0, 6.0}, space).limits_kept);
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &end, {3.0, 0.5}, space).limits_kept);
  SplineState elsewhere = end;
  elsewhere.p.x() += 1e-6;
  EXPECT_FALSE(Proven(Certify(curve, 0.0, nullptr, &elsewhere, {3.0, 6.0}, space)));
  EXPECT_TRUE(Proven(Certify(curve, 0.0, &start, &end, {3.0, 6.0}, space)));
  SplineState beside = start;
  beside.p.y() += 1e-6;
  EXPECT_FALSE(Proven(Certify(curve, 0.0, &beside, &end, {3.0, 6.0}, space)));
  beside = start;
  beside.v.y() += 1e-6;
  EXPECT_FALSE(Proven(Certify(curve, 0.0, &beside, &end, {3.0, 6.0}, space)));
  map.SetOccupied({0.0, 0.0, 0.0});
  const Certificate hit = Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, space);
  EXPECT_FALSE(hit.clear);
  EXPECT_NEAR(curve.Evaluate(hit.first_hit_t).p_WB.x(), -0.35, 0.1);
  EXPECT_TRUE(Proven(Certify(curve, 3.0, nullptr, &end, {3.0, 6.0}, space)));  // already past it
}

TEST(Certificate, AStartBeyondALimitIsHeldToItsRecovery) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkFree(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState fast{{-2, 0, 0}, {3.5, 0, 0}, {0, 0, 0}};
  const SplineState slow{{1.0, 0, 0}, {0.5, 0, 0}, {0, 0, 0}};
  const UniformBspline recovers(HermiteControlPoints(fast, slow, 12, 1.5), 1.5 / 12, 0.0);
  const Certificate yes = Certify(recovers, 0.0, nullptr, &slow, {3.0, 6.0}, space);
  EXPECT_TRUE(yes.recovering);
  EXPECT_TRUE(yes.limits_kept);
  const SplineState faster{{2.0, 0, 0}, {3.5, 0, 0}, {0, 0, 0}};
  const UniformBspline persists(HermiteControlPoints(fast, faster, 12, 1.2), 0.1, 0.0);
  EXPECT_FALSE(Certify(persists, 0.0, nullptr, &faster, {3.0, 6.0}, space).limits_kept);
}

TEST(Certificate, WhatTheAttitudeCannotFollowBreaksALimit) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkFree(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}, end{{2, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  ControlPoints q = HermiteControlPoints(start, end, 40, 4.0);
  q(1, 20) += 0.02;  // to the side and back within a few tenths of a second
  const UniformBspline curve(q, 0.1, 0.0);
  Limits limits{4.0, 6.0};
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &end, limits, space).limits_kept);
  limits.body_rate = 10.0;
  const Certificate turns = Certify(curve, 0.0, nullptr, &end, limits, space);
  EXPECT_TRUE(turns.limits_kept);
  EXPECT_FALSE(turns.earlier);
  EXPECT_EQ(turns.body_rate_bound, BoundDerivatives(curve, limits.pull_W).body_rate);
  EXPECT_LE(turns.body_rate_bound, 10.0);
}

TEST(Certificate, LimitsAreKeptUpToTheSlackOfRounding) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkFree(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}, end{{2, 1, 0}, {0, 0, 0}, {0, 0, 0}};
  const UniformBspline curve(HermiteControlPoints(start, end, 12, 4.0), 4.0 / 12, 0.0);
  const DerivativeBounds bounds = BoundDerivatives(curve);
  Limits exact;
  exact.speed = bounds.speed;
  exact.acceleration = bounds.acceleration;
  exact.body_rate = bounds.body_rate;
  for (double Limits::*limit : {&Limits::speed, &Limits::acceleration, &Limits::body_rate}) {
    for (const double share : {0.5, 2.0}) {
      Limits limits = exact;
      limits.*limit -= share * kLimitSlack;
      EXPECT_EQ(Certify(curve, 0.0, nullptr, &end, limits, space).limits_kept, share < 1.0);
    }
  }
}

TEST(Certificate, AStartInTheInflatedZoneMayOnlyLeave) {
  OccupancyMap map(SmallMap(0.4));
  map.MarkFree(Eigen::Vector3d::Zero(), 5.0);
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  const SplineState inside{{0.35, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const SplineState out{{1.5, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const SplineState through{{-1.5, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const UniformBspline leaves(HermiteControlPoints(inside, out, 12, 2.0), 2.0 / 12, 0.0);
  const UniformBspline crosses(HermiteControlPoints(inside, through, 12, 2.0), 2.0 / 12, 0.0);
  const Certificate yes = Certify(leaves, 0.0, nullptr, &out, {3.0, 6.0}, space);
  EXPECT_TRUE(yes.escaping);
  EXPECT_TRUE(Proven(yes));
  EXPECT_LT(yes.clearance, 0.4);
  EXPECT_FALSE(Proven(Certify(crosses, 0.0, nullptr, &through, {3.0, 6.0}, space)));
}

TEST(Certificate, AnEscapeProvesNothingFromInsideAnObstacleOrPastAnother) {
  OccupancyMap map(SmallMap(0.4));
  map.MarkFree(Eigen::Vector3d::Zero(), 5.0);
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  const auto curve = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const SplineState start{from, {0, 0, 0}, {0, 0, 0}}, end{to, {0, 0, 0}, {0, 0, 0}};
    return UniformBspline(HermiteControlPoints(start, end, 12, 2.0), 2.0 / 12, 0.0);
  };
  const UniformBspline inside = curve({0.05, 0.05, 0.05}, {1.5, 0.05, 0.05});
  EXPECT_FALSE(Proven(Certify(inside, 0.0, nullptr, nullptr, {3.0, 6.0}, space)));
  // Leaves one obstacle and comes nearer to a second than it was to the first.
  map.SetOccupied({0.85, 0.05, 0.05});
  const UniformBspline between = curve({0.25, 0.05, 0.05}, {0.70, 0.05, 0.05});
  EXPECT_FALSE(Proven(Certify(between, 0.0, nullptr, nullptr, {3.0, 6.0}, space)));
}

// Away from a wall it may sink as far as the floor, and from below the floor not at all.
TEST(Certificate, AnEscapeSinksNoLowerThanTheFloor) {
  OccupancyMap map(SmallMap(0.4));
  map.MarkFree(Eigen::Vector3d::Zero(), 5.0);
  for (int i = -20; i < 20; ++i) map.SetOccupied({0.05, 0.05, 0.1 * i + 0.05});  // a post
  FreeSpace space = SpaceOf(map);
  const auto escapes = [&](double floor, double height, double change) {
    space.floor = floor;
    const SplineState start{{0.35, 0.05, height}, {0, 0, 0}, {0, 0, 0}};
    const SplineState end{{1.0, 0.05, height + change}, {0, 0, 0}, {0, 0, 0}};
    const UniformBspline curve(HermiteControlPoints(start, end, 12, 2.0), 2.0 / 12, 0.0);
    return Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, space).escaping;
  };
  EXPECT_TRUE(escapes(0.3, 0.8, -0.3)) << "above the floor";
  EXPECT_FALSE(escapes(0.3, 0.8, -0.6)) << "through the floor";
  EXPECT_TRUE(escapes(0.3, 0.2, 0.2)) << "up from below it";
  EXPECT_FALSE(escapes(0.3, 0.2, -0.3)) << "down from below it";
}

TEST(Certificate, WithoutAProvenPairNothingPasses) {
  OccupancyMap map(SmallMap(0.2));
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}, end{{2, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const UniformBspline curve(HermiteControlPoints(start, end, 12, 4.0), 4.0 / 12, 0.0);
  const Certificate alone = Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, space);
  EXPECT_TRUE(Proven(alone));
  EXPECT_FALSE(alone.passed());
}

TEST(Certificate, FloorAndCeilingAreKeptToTheMillimetre) {
  OccupancyMap map(SmallMap(0.2));
  FreeSpace space = SpaceOf(map);
  space.floor = 0.45;
  space.ceiling = 1.05;
  const auto level = [&](double z) {
    const SplineState a{{-1, 0, z}, {0, 0, 0}, {0, 0, 0}}, b{{1, 0, z}, {0, 0, 0}, {0, 0, 0}};
    const UniformBspline curve(HermiteControlPoints(a, b, 12, 4.0), 4.0 / 12, 0.0);
    return Certify(curve, 0.0, nullptr, &b, {3.0, 6.0}, space).clear;
  };
  EXPECT_TRUE(level(0.45));
  EXPECT_TRUE(level(1.05));
  // In the same cells, but beyond: before, a floor of 0.45 m let 0.401 m pass.
  EXPECT_FALSE(level(0.449));
  EXPECT_FALSE(level(0.401));
  EXPECT_FALSE(level(1.051));
  EXPECT_FALSE(level(1.09));
}

}  // namespace
}  // namespace touchdown::planning
