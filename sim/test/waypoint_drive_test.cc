// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/sim/waypoint_drive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "touchdown/sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using ::testing::HasSubstr;

std::vector<PadWaypoint> Street() {
  return {{{0.0, 0.0}, 2.0, 2},   {{8.0, 0.0}, 12.0, 3},   {{8.0, 0.0}, 15.0, 4},
          {{16.0, 1.0}, 25.0, 5}, {{16.0, 12.0}, 39.0, 6}, {{9.0, 18.0}, 50.0, 7}};
}

TEST(WaypointDrive, ComesNearEveryPointAtItsTime) {
  const std::vector<PadWaypoint> points = Street();
  const PathDrive drive = WaypointDrive(points, 0.5, 1.0);
  for (const PadWaypoint& point : points) {
    const Eigen::Vector2d p = drive.path.At(drive.pace.At(point.t).s).p;
    EXPECT_LT((p - point.p).norm(), 0.6)
        << point.line;  // corners are cut, starts and stops smoothed
  }
  // Before, after and, up to what the smoothing takes, at the stop it stands.
  EXPECT_NEAR(drive.pace.At(-3.0).speed, 0.0, 1e-12);
  EXPECT_NEAR(drive.path.At(drive.pace.At(-3.0).s).p.norm(), 0.0, 1e-9);
  EXPECT_NEAR(drive.pace.At(60.0).speed, 0.0, 1e-12);
  EXPECT_LT((drive.path.At(drive.pace.At(60.0).s).p - points.back().p).norm(), 1e-9);
  EXPECT_LT(drive.pace.At(13.5).speed, 0.15);
}

TEST(WaypointDrive, TurnsAreNoSharperThanAsked) {
  const PathDrive drive = WaypointDrive(Street(), 0.4, 0.6);
  double across = 0.0, jerk = 0.0;
  for (double s = 0.0; s < drive.path.length(); s += 0.01) {
    const PathPoint point = drive.path.At(s);
    const double v = 0.85;  // a little more than the fastest leg
    across = std::max(across, v * v * std::abs(point.curvature));
    jerk = std::max(jerk, v * v * v * std::abs(point.curvature_slope));
  }
  EXPECT_LT(across, 0.5);
  EXPECT_LT(jerk, 0.75);
  EXPECT_GT(std::max(across / 0.4, jerk / 0.6), 0.9);
  EXPECT_LE(drive.pace.MaxAcceleration(), 0.4 + 1e-12);
  EXPECT_LE(drive.pace.MaxJerk(), 0.6 + 1e-12);
}

TEST(WaypointDrive, LegsAreStraightBetweenTurns) {
  const PathDrive drive = WaypointDrive(Street(), 0.5, 1.0);
  const PathPoint first = drive.path.At(2.0);
  EXPECT_LT((first.p - Eigen::Vector2d(2.0, 0.0)).norm(), 1e-12);
  // Somewhere on the leg north the path runs through its middle, due north.
  double nearest = 1.0;
  for (double s = 0.0; s < drive.path.length(); s += 0.01) {
    const PathPoint at = drive.path.At(s);
    const double off = (at.p - Eigen::Vector2d(16.0, 6.5)).norm();
    if (off < nearest) {
      nearest = off;
      EXPECT_NEAR(at.yaw, 1.5707963267948966, 1e-9);
    }
  }
  EXPECT_LT(nearest, 0.01);
}

TEST(WaypointDrive, RefusesNamingTheLine) {
  const auto message = [](auto change) {
    std::vector<PadWaypoint> points = Street();
    change(&points);
    return test::MessageOf<std::invalid_argument>([&] { WaypointDrive(points, 0.5, 1.0); });
  };
  EXPECT_EQ(message([](auto*) {}), "");
  EXPECT_THAT(message([](auto* p) { p->resize(1); }), HasSubstr("two places"));
  EXPECT_THAT(message([](auto* p) { (*p)[3].t = 14.0; }), HasSubstr("line 5: its time is 14 s"));
  EXPECT_THAT(message([](auto* p) {
                (*p)[3].p = {1.0, 0.2};
              }),
              HasSubstr("line 3: the path turns by 178 degrees"));
  EXPECT_THAT(message([](auto* p) {
                (*p)[5] = {{15.0, 12.0}, 40.5, 7};
              }),
              HasSubstr("line 6: the turn by 90 degrees at 0.7"));
}

}  // namespace
}  // namespace touchdown::sim
