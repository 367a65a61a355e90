// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/hostile/hostile_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "estimation/base/degrees.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/obstacles/obstacle_field.h"

namespace touchdown::evaluation {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kMapCell = 0.1;      // of the map [m]
constexpr double kPadShare = 0.4;     // of limits.acceleration, for following the pad
constexpr double kGentlestPad = 0.2;  // [m/s]
constexpr double kEightReach =
    5.67;  // of a figure of eight to its side, in radii (docs/pad_motions.md)
constexpr double kEightWidth = 1.05;   // ahead of and behind its start, in radii
constexpr double kEightLength = 15.1;  // of its way, in radii
constexpr double kReversalTime =
    2.25;  // takes this over the acceleration, times the change of speed
constexpr double kDeckHeadroom = 0.4;  // as the scenario check has it [m]
constexpr double kDeckRoom = 0.01;     // more than the scenario check asks for [m]

// A speed of the pad on a curve of this radius that the vehicle's acceleration can follow [m/s].
double PadSpeed(double radius, sim::RandomStream& draw, const Scenario& scenario) {
  const double wanted = DrawIn(draw, {0.3, 1.2});
  const double followed =
      std::sqrt(kPadShare * std::min(scenario.limits.acceleration, 5.0) * radius);
  return std::max(kGentlestPad, std::min(wanted, followed));
}

// Across to the left of +x, then back.
void EightLane(double x, double radius, sim::RandomStream& draw, Scenario* s) {
  s->pad.motion = "figure_eight";
  s->pad.speed = PadSpeed(radius, draw, *s);
  s->pad.turn_rate = s->pad.speed / radius;
  s->pad.start << x + kEightWidth * radius, -0.5 * kEightReach * radius + DrawIn(draw, {-2.0, 2.0});
  s->pad.phase = DrawIn(draw, {0.0, kEightLength * radius});
}

void CircleLane(double x, double radius, sim::RandomStream& draw, Scenario* s) {
  s->pad.motion = "circle";
  s->pad.speed = PadSpeed(radius, draw, *s);
  s->pad.turn_rate = s->pad.speed / radius;
  s->pad.start << x + radius, -radius + DrawIn(draw, {-2.0, 2.0});
  s->pad.phase = DrawIn(draw, {0.0, 2.0 * kPi * radius});
}

// The motion of a world: mirrored at y = 0, turned to the left, shifted.
struct Move {
  bool mirrored = false;
  double turn_deg = 0.0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();

  Eigen::Vector2d Point(Eigen::Vector2d p) const {
    if (mirrored) p.y() = -p.y();
    return Eigen::Rotation2Dd(turn_deg * estimation::kRadPerDeg) * p + shift;
  }
  double Heading(double deg) const {
    return std::remainder((mirrored ? -deg : deg) + turn_deg, 360.0);
  }
};

}  // namespace

double DrawIn(sim::RandomStream& draw, const Span& range) {
  return draw.Uniform(range.lo, range.hi);
}

bool DrawChance(sim::RandomStream& draw, double probability) {
  return draw.Uniform(0.0, 1.0) < probability;
}

int DrawOneOf(sim::RandomStream& draw, int count) {
  return std::min(count - 1, static_cast<int>(draw.Uniform(0.0, count)));
}

void AddBox(const Span& x, const Span& y, double base, double top, Scenario* scenario) {
  BoxObstacle box;
  box.centre << 0.5 * (x.lo + x.hi), 0.5 * (y.lo + y.hi);
  box.size << x.hi - x.lo, y.hi - y.lo, top - base;
  box.base = base;
  scenario->boxes.push_back(box);
}

void AddWall(const Span& x, const Span& y, Scenario* scenario) {
  AddBox(x, y, 0.0, kTallWall, scenario);
}

void AddPost(double x, double y, double diameter, double height, Scenario* scenario) {
  CylinderObstacle post;
  post.centre << x, y;
  post.radius = 0.5 * diameter;
  post.height = height;
  scenario->cylinders.push_back(post);
}

void StartAt(double x, double y, double z, double yaw_deg, Scenario* scenario) {
  scenario->start.position << x, y, z;
  scenario->start.yaw_deg = yaw_deg;
}

void LaneBeyond(double x, sim::RandomStream& draw, Scenario* scenario) {
  const double nearest = x + kLaneRoom + DrawIn(draw, {0.0, 2.0});
  const int kind = DrawOneOf(draw, 3);
  if (kind == 0) EightLane(nearest, DrawIn(draw, {2.0, 3.0}), draw, scenario);
  if (kind == 1) CircleLane(nearest, DrawIn(draw, {2.5, 4.0}), draw, scenario);
  if (kind == 2) StraightLane(nearest, DrawIn(draw, {8.0, 14.0}), draw, scenario);
}

void StraightLane(double x, double length, sim::RandomStream& draw, Scenario* scenario) {
  Scenario::Pad& pad = scenario->pad;
  pad.motion = "reversing";
  // Both changes of speed must fit into the length.
  pad.speed = PadSpeed(length / (2.0 * kReversalTime), draw, *scenario);
  pad.acceleration = std::max(0.1, 2.1 * kReversalTime * pad.speed * pad.speed / length);
  pad.go_time = length / pad.speed;
  // The first change of speed is over at the start: it begins half a change before.
  const double early = kReversalTime * pad.speed * pad.speed / pad.acceleration;
  pad.start << x, -0.5 * length + early;
  pad.heading_deg = 90.0;
  pad.phase = DrawIn(draw, {0.0, 2.0 * length});
}

void TurnWorld(sim::RandomStream& draw, Scenario* scenario) {
  Move move;
  move.mirrored = DrawChance(draw, 0.5);
  move.turn_deg = DrawIn(draw, {0.0, 360.0});
  move.shift << DrawIn(draw, {0.0, kMapCell}), DrawIn(draw, {0.0, kMapCell});
  for (BoxObstacle& box : scenario->boxes) {
    box.centre = move.Point(box.centre);
    box.turn_deg.z() = move.Heading(box.turn_deg.z());
  }
  for (CylinderObstacle& post : scenario->cylinders) post.centre = move.Point(post.centre);
  Scenario::Pad& pad = scenario->pad;
  pad.start = move.Point(pad.start);
  pad.heading_deg = move.Heading(pad.heading_deg);
  if (move.mirrored) pad.turn_rate = -pad.turn_rate;
  scenario->start.position.head<2>() = move.Point(scenario->start.position.head<2>());
  scenario->start.yaw_deg = move.Heading(scenario->start.yaw_deg);
}

double StartRoom(const Scenario& scenario) {
  double room = std::numeric_limits<double>::infinity();
  for (const NamedObstacle& named : ObstaclesOf(scenario)) {
    room = std::min(room, sim::SignedDistance(named.obstacle, scenario.start.position));
  }
  return room;
}

bool LaneIsClear(const Scenario& scenario, const Registries& registries, double horizon) {
  constexpr double kStep = 0.1;  // [s]
  const double needed = scenario.pad.deck_size * std::sqrt(0.5) + kDeckRoom;
  // What begins above the deck's headroom does not count.
  const double top = scenario.pad.deck_height + kDeckHeadroom;
  std::vector<sim::Obstacle> low;
  for (const NamedObstacle& named : ObstaclesOf(scenario)) {
    if (sim::BoundsOf(named.obstacle).min.z() < top) low.push_back(named.obstacle);
  }
  const auto course = PadCourseOf(scenario, registries, scenario.pad.phase, 0);
  for (int i = 0; i * kStep <= horizon; ++i) {
    const Eigen::Vector3d p_WP = course->At(i * kStep).p_WP;
    for (const sim::Obstacle& obstacle : low) {
      const sim::Bounds bounds = sim::BoundsOf(obstacle);
      const double z = std::clamp(0.5 * top, bounds.min.z(), bounds.max.z());
      if (sim::SignedDistance(obstacle, {p_WP.x(), p_WP.y(), z}) < needed) return false;
    }
  }
  return true;
}

}  // namespace touchdown::evaluation
