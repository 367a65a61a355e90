// SPDX-License-Identifier: BSD-3-Clause
#include "sim/pad/waypoint_drive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using ::testing::HasSubstr;

std::vector<PadWaypoint> Street() {
  return {{{0.0, 0.0}, 2.0, 2},   {{8.0, 0.0}, 12.0, 3},   {{8.0, 0.0}, 17.0, 4},
          {{16.0, 1.0}, 27.0, 5}, {{16.0, 12.0}, 41.0, 6}, {{9.0, 18.0}, 52.0, 7}};
}

// Of the path, the nearest to `p`: by symmetry the middle of a turn.
double WayTo(const Eigen::Vector2d& p, const CurvatureChain& path) {
  double way = 0.0, least = INFINITY;
  for (double s = 0.0; s < path.length(); s += 1e-3) {
    const double off = (path.At(s).p - p).norm();
    if (off < least) {
      least = off;
      way = s;
    }
  }
  return way;
}

TEST(WaypointDrive, IsAtEveryPointAtItsTimeButForWhatSmoothingTakes) {
  const std::vector<PadWaypoint> points = Street();
  const PathDrive drive = WaypointDrive(points, 0.5, 1.0);
  const double w = Pace::SmoothingFor(drive.pace.GreatestSpeed(), 0.5, 1.0);
  for (const PadWaypoint& point : points) {
    // Changes of speed are over within 1.5 w, and all legs are longer.
    const double change =
        drive.pace.At(point.t + 1.5 * w).speed - drive.pace.At(point.t - 1.5 * w).speed;
    EXPECT_NEAR(drive.pace.At(point.t).s, WayTo(point.p, drive.path) + 13.0 / 64.0 * w * change,
                2e-3)
        << point.line;
    if (change > 0.7) {
      EXPECT_GT(drive.pace.At(point.t).s, WayTo(point.p, drive.path) + 0.15);
    }
  }
}

TEST(WaypointDrive, StandsBetweenChangesOfSpeed) {
  const std::vector<PadWaypoint> points = Street();
  const PathDrive drive = WaypointDrive(points, 0.5, 1.0);
  const double change = 1.5 * Pace::SmoothingFor(drive.pace.GreatestSpeed(), 0.5, 1.0);
  const auto stands = [&](double t, const Eigen::Vector2d& p) {
    EXPECT_NEAR(drive.pace.At(t).speed, 0.0, 1e-12) << t;
    EXPECT_LT((drive.path.At(drive.pace.At(t).s).p - p).norm(), 1e-9) << t;
  };
  const Eigen::Vector2d corner = drive.path.At(drive.pace.At(14.5).s).p;
  EXPECT_LT((corner - points[1].p).norm(), 0.03);  // cut
  for (const double t : {-300.0, 0.0, 2.0 - change}) stands(t, points.front().p);
  for (const double t : {12.0 + change, 14.5, 17.0 - change}) stands(t, corner);
  for (const double t : {52.0 + change, 400.0}) stands(t, points.back().p);
  for (const double t : {2.1 - change, 11.9 + change, 17.1 - change, 51.9 + change}) {
    EXPECT_GT(drive.pace.At(t).speed, 1e-6) << t;
  }
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
  EXPECT_THAT(message([](auto* p) { (*p)[3].t = 16.0; }), HasSubstr("line 5: its time is 16 s"));
  EXPECT_THAT(message([](auto* p) { (*p)[1].t = 2.3; }),
              HasSubstr("line 3: the way there is driven at 26.67 m/s; allowed is at most 20"));
  EXPECT_THAT(message([](auto* p) { (*p)[2].t = 15.0; }),
              HasSubstr("line 3: the stop of 3 s there is shorter than a change of speed, which "
                        "takes 3.8"));
  EXPECT_THAT(message([](auto* p) {
                (*p)[3].p = {1.0, 0.2};
              }),
              HasSubstr("line 3: the path turns by 178 degrees"));
  EXPECT_THAT(message([](auto* p) {
                (*p)[5] = {{15.0, 12.0}, 42.5, 7};
              }),
              HasSubstr("line 6: the turn by 90 degrees at 0.7"));
}

}  // namespace
}  // namespace touchdown::sim
