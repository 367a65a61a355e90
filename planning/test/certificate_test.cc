// SPDX-License-Identifier: BSD-3-Clause
// Each part of the certificate, proven and refused.

#include "touchdown/planning/certificate.h"

#include <gtest/gtest.h>

#include "touchdown/planning/boundary_lift.h"
#include "touchdown/planning/test/small_map.h"

namespace touchdown::planning {
namespace {

TEST(Certificate, ProvesOrNamesEachPart) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkOwnVolume(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}, end{{2, 0, 0}, {0.5, 0, 0}, {0, 0, 0}};
  const UniformBspline curve(HermiteControlPoints(start, end, 12, 4.0), 4.0 / 12, 0.0);
  EXPECT_TRUE(Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, 0.1, space).passed());
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &end, {1.0, 6.0}, 0.1, space).limits_kept);
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &end, {3.0, 0.5}, 0.1, space).limits_kept);
  SplineState elsewhere = end;
  elsewhere.p.x() += 1e-6;
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &elsewhere, {3.0, 6.0}, 0.1, space).passed());
  EXPECT_TRUE(Certify(curve, 0.0, &start, &end, {3.0, 6.0}, 0.1, space).passed());
  SplineState beside = start;
  beside.p.y() += 1e-6;
  EXPECT_FALSE(Certify(curve, 0.0, &beside, &end, {3.0, 6.0}, 0.1, space).passed());
  beside = start;
  beside.v.y() += 1e-6;
  EXPECT_FALSE(Certify(curve, 0.0, &beside, &end, {3.0, 6.0}, 0.1, space).passed());
  map.SetOccupied({0.0, 0.0, 0.0});
  const Certificate hit = Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, 0.1, space);
  EXPECT_FALSE(hit.clear);
  EXPECT_NEAR(curve.Evaluate(hit.first_hit_t).p_WB.x(), -0.35, 0.1);
  EXPECT_TRUE(
      Certify(curve, 3.0, nullptr, &end, {3.0, 6.0}, 0.1, space).passed());  // already past it
}

TEST(Certificate, AStartBeyondALimitIsHeldToItsRecovery) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkOwnVolume(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState fast{{-2, 0, 0}, {3.5, 0, 0}, {0, 0, 0}};
  const SplineState slow{{1.0, 0, 0}, {0.5, 0, 0}, {0, 0, 0}};
  const UniformBspline recovers(HermiteControlPoints(fast, slow, 12, 1.5), 1.5 / 12, 0.0);
  const Certificate yes = Certify(recovers, 0.0, nullptr, &slow, {3.0, 6.0}, 0.1, space);
  EXPECT_TRUE(yes.recovering);
  EXPECT_TRUE(yes.limits_kept);
  const SplineState faster{{2.0, 0, 0}, {3.5, 0, 0}, {0, 0, 0}};
  const UniformBspline persists(HermiteControlPoints(fast, faster, 12, 1.2), 0.1, 0.0);
  EXPECT_FALSE(Certify(persists, 0.0, nullptr, &faster, {3.0, 6.0}, 0.1, space).limits_kept);
}

TEST(Certificate, AStartInTheInflatedZoneMayOnlyLeave) {
  OccupancyMap map(SmallMap(0.4));
  map.MarkOwnVolume(Eigen::Vector3d::Zero(), 5.0);
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  const SplineState inside{{0.35, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const SplineState out{{1.5, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const SplineState through{{-1.5, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const UniformBspline leaves(HermiteControlPoints(inside, out, 12, 2.0), 2.0 / 12, 0.0);
  const UniformBspline crosses(HermiteControlPoints(inside, through, 12, 2.0), 2.0 / 12, 0.0);
  const Certificate yes = Certify(leaves, 0.0, nullptr, &out, {3.0, 6.0}, 0.1, space);
  EXPECT_TRUE(yes.escaping);
  EXPECT_TRUE(yes.passed());
  EXPECT_LT(yes.clearance, 0.4);
  EXPECT_FALSE(Certify(crosses, 0.0, nullptr, &through, {3.0, 6.0}, 0.1, space).passed());
}

TEST(Certificate, AnEscapeProvesNothingFromInsideAnObstacleOrPastAnother) {
  OccupancyMap map(SmallMap(0.4));
  map.MarkOwnVolume(Eigen::Vector3d::Zero(), 5.0);
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  const auto curve = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const SplineState start{from, {0, 0, 0}, {0, 0, 0}}, end{to, {0, 0, 0}, {0, 0, 0}};
    return UniformBspline(HermiteControlPoints(start, end, 12, 2.0), 2.0 / 12, 0.0);
  };
  const UniformBspline inside = curve({0.05, 0.05, 0.05}, {1.5, 0.05, 0.05});
  EXPECT_FALSE(Certify(inside, 0.0, nullptr, nullptr, {3.0, 6.0}, 0.1, space).passed());
  // Leaves one obstacle and comes nearer to a second than it was to the first.
  map.SetOccupied({0.85, 0.05, 0.05});
  const UniformBspline between = curve({0.25, 0.05, 0.05}, {0.70, 0.05, 0.05});
  EXPECT_FALSE(Certify(between, 0.0, nullptr, nullptr, {3.0, 6.0}, 0.1, space).passed());
}

TEST(Certificate, NeedsRoomToBrakeInObservedSpace) {
  OccupancyMap map(SmallMap(0.2));
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {2, 0, 0}, {0, 0, 0}}, end{{2, 0, 0}, {2, 0, 0}, {0, 0, 0}};
  const UniformBspline curve(HermiteControlPoints(start, end, 12, 2.0), 2.0 / 12, 0.0);
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, 0.1, space).passed());
  // 2 m/s take 4 / (2 * 0.6 * 6) = 0.56 m, from where the vehicle is after 0.1 s.
  map.MarkOwnVolume({-2, 0, 0}, 0.6);
  EXPECT_FALSE(Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, 0.1, space).stops_in_observed_space);
  map.MarkOwnVolume({-2, 0, 0}, 0.9);
  EXPECT_TRUE(Certify(curve, 0.0, nullptr, &end, {3.0, 6.0}, 0.1, space).passed());
}

}  // namespace
}  // namespace touchdown::planning
