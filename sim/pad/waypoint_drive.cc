// SPDX-License-Identifier: BSD-3-Clause
// A corner becomes two ramps of the curvature, up to k and down again, each of length l = angle / k. At speed v the
// acceleration across is at most v^2 k. Its rate is v^3 k / l times the steepest slope of a ramp. All such turns by one
// angle are similar. So the distance from the corner to the turn's start is l times a factor. This factor is half the
// chord of the turn with l = 1, over the cosine of half the angle.

#include "sim/pad/waypoint_drive.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

namespace touchdown::sim {
namespace {

constexpr double kFastest = 20.0;  // [m/s]
constexpr double kSharpest = 150.0 / 180.0 * std::numbers::pi;
constexpr double kLeastTurn = 1e-6;  // [rad]
constexpr double kStand = 10.0;      // knots so long before and after the drive [s]

template <typename... Numbers>
[[noreturn]] void Refuse(const PadWaypoint& at, const char* format, Numbers... numbers) {
  char text[200];
  std::snprintf(text, sizeof(text), format, numbers...);
  throw std::invalid_argument("line " + std::to_string(at.line) + ": " + text);
}

struct Place {
  PadWaypoint arrival;
  double t_leave = 0.0;  // [s]
  double s = 0.0;        // along the finished path [m]
};

std::vector<Place> PlacesOf(const std::vector<PadWaypoint>& waypoints) {
  std::vector<Place> places;
  for (const PadWaypoint& point : waypoints) {
    if (!places.empty() && !(point.t > places.back().t_leave)) {
      Refuse(point, "its time is %g s and must be later than the one before, %g s", point.t,
             places.back().t_leave);
    }
    if (!places.empty() && (point.p - places.back().arrival.p).norm() < kSamePlace) {
      places.back().t_leave = point.t;
    } else {
      places.push_back({point, point.t, 0.0});
    }
  }
  if (places.size() < 2) throw std::invalid_argument("there must be two places or more");
  return places;
}

struct Leg {
  double length = 0.0;
  double heading = 0.0;
  double speed = 0.0;  // straight from place to place [m/s]
};

std::vector<Leg> LegsOf(const std::vector<Place>& places) {
  std::vector<Leg> legs;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Eigen::Vector2d way = places[i + 1].arrival.p - places[i].arrival.p;
    const double speed = way.norm() / (places[i + 1].arrival.t - places[i].t_leave);
    if (speed > kFastest) {
      Refuse(places[i + 1].arrival, "the way there is driven at %.2f m/s; allowed is at most %g",
             speed, kFastest);
    }
    legs.push_back({way.norm(), std::atan2(way.y(), way.x()), speed});
  }
  return legs;
}

struct Turn {
  double ramp = 0.0;       // length of each of its two [m]; 0: straight on
  double curvature = 0.0;  // its greatest, signed [1/m]
  double tangent = 0.0;    // from the corner to where it begins [m]
};

// A turn by `angle` with ramps of length 1: the way from corner to beginning.
double UnitTangent(double angle) {
  CurvatureChain unit(Eigen::Vector2d::Zero(), 0.0);
  unit.Append(1.0, 0.0, angle);
  unit.Append(1.0, angle, 0.0);
  return 0.5 * unit.At(2.0).p.norm() / std::cos(0.5 * angle);
}

Turn TurnAt(const PadWaypoint& corner, const Leg& in, const Leg& out, double acceleration,
            double jerk) {
  const double angle = std::remainder(out.heading - in.heading, 2.0 * std::numbers::pi);
  const double sharp = std::abs(angle);
  if (sharp < kLeastTurn) return {};
  if (sharp > kSharpest) {
    Refuse(corner, "the path turns by %.0f degrees there; allowed is at most 150",
           sharp / std::numbers::pi * 180.0);
  }
  const double v = std::max(in.speed, out.speed);
  const double k =
      std::min(acceleration / (v * v), std::sqrt(jerk * sharp / (kSteepestStep * v * v * v)));
  Turn turn;
  turn.ramp = sharp / k;
  turn.curvature = std::copysign(k, angle);
  turn.tangent = turn.ramp * UnitTangent(sharp);
  const double room = 0.5 * std::min(in.length, out.length);
  if (turn.tangent > room) {
    Refuse(corner,
           "the turn by %.0f degrees at %.2f m/s needs %.2f m of the path before and after it, and "
           "half a leg is %.2f m",
           sharp / std::numbers::pi * 180.0, v, turn.tangent, room);
  }
  return turn;
}

Pace PaceOf(const std::vector<Place>& places, double acceleration, double jerk) {
  std::vector<Pace::Knot> knots = {{places.front().arrival.t - kStand, 0.0}};
  double fastest = 0.0;
  for (const Place& place : places) {
    const Pace::Knot before = knots.back();
    knots.push_back({place.arrival.t, place.s});
    fastest = std::max(fastest, (place.s - before.s) / (place.arrival.t - before.t));
    if (place.t_leave > place.arrival.t) knots.push_back({place.t_leave, place.s});
  }
  knots.push_back({knots.back().t + kStand, knots.back().s});
  const double smoothing = Pace::SmoothingFor(fastest, acceleration, jerk);
  for (std::size_t i = 1; i + 1 < places.size(); ++i) {
    const double stop = places[i].t_leave - places[i].arrival.t;
    if (stop > 0.0 && stop < 3.0 * smoothing) {
      Refuse(places[i].arrival,
             "the stop of %g s there is shorter than a change of speed, which takes %.2f s at "
             "%.2f m/s, the speed of the fastest leg",
             stop, 3.0 * smoothing, fastest);
    }
  }
  return Pace(std::move(knots), smoothing);
}

}  // namespace

PathDrive WaypointDrive(const std::vector<PadWaypoint>& waypoints, double acceleration,
                        double jerk) {
  std::vector<Place> places = PlacesOf(waypoints);
  const std::vector<Leg> legs = LegsOf(places);
  CurvatureChain path(places.front().arrival.p, legs.front().heading);
  Turn last;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    Turn next;
    if (i + 1 < legs.size()) {
      next = TurnAt(places[i + 1].arrival, legs[i], legs[i + 1], acceleration, jerk);
    }
    path.Append(legs[i].length - last.tangent - next.tangent, 0.0, 0.0);
    places[i + 1].s = path.length() + next.ramp;
    if (next.ramp > 0.0) {
      path.Append(next.ramp, 0.0, next.curvature);
      path.Append(next.ramp, next.curvature, 0.0);
    }
    last = next;
  }
  path.Append(1.0, 0.0, 0.0);  // goes on straight, should the smoothed pace ask for it

  return {std::move(path), PaceOf(places, acceleration, jerk)};
}

}  // namespace touchdown::sim
