// SPDX-License-Identifier: BSD-3-Clause
// The forests and the fast targets are those in which the released EGO-Planner was measured. Slits, dead ends and yards
// test what a forest does not.
#include "evaluation/studies/replan/scene_sets.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "planning/baselines/ego/ego_reference.h"

namespace touchdown::evaluation {
namespace {

using Eigen::Vector3d;
using sim::RandomStream;

constexpr double kEndSpeed = 0.5;    // largest of an end that crosses, of the speed limit
constexpr double kFastest = 0.9;     // of a target ahead, of the speed limit
constexpr double kWallHeight = 3.0;  // above every ceiling [m]
constexpr double kStartHeight = 1.0;
constexpr double kClutter = 0.375;  // pillars per square metre
constexpr double kThicket = 0.5;

Vector3d Level(double course) { return {std::cos(course), std::sin(course), 0.0}; }

SceneSketch InForest(ForestScene forest, double horizon) {
  SceneSketch sketch;
  sketch.start = forest.start;
  sketch.height = forest.height;
  sketch.target = forest.start.p + horizon * forest.ahead;
  sketch.field = std::move(forest.field);
  return sketch;
}

/// The end drives with up to half the speed limit in any direction.
void LetEndCross(const SceneOptions& options, RandomStream& stream, SceneSketch* sketch) {
  const double speed = stream.Uniform(0.0, kEndSpeed * options.kind.limits.speed);
  sketch->v_end = speed * Level(stream.Uniform(-std::numbers::pi, std::numbers::pi));
}

SceneSketch DrawCrossing(const SceneOptions& options, RandomStream& stream) {
  SceneSketch sketch = InForest(DrawForestScene(options, &stream), options.horizon);
  LetEndCross(options, stream, &sketch);
  return sketch;
}

SceneSketch DrawWithDensity(double density, SceneOptions options, RandomStream& stream) {
  options.density = density;
  return DrawCrossing(options, stream);
}

/// On the straight reference to the goal, a horizon ahead, with the velocity that the reference has there.
SceneSketch DrawPointAhead(const SceneOptions& options, RandomStream& stream) {
  ForestScene forest = DrawForestScene(options, &stream);
  planning::EgoOptions ego;
  ego.max_speed = options.kind.limits.speed;
  ego.max_acceleration = options.kind.limits.acceleration;
  ego.horizon = options.horizon;
  planning::EgoReference reference;
  reference.Set(forest.start.p, forest.start.v, forest.goal, Vector3d::Zero(), ego);
  const planning::LocalTarget ahead = reference.Target(forest.start.p, ego);
  SceneSketch sketch = InForest(std::move(forest), options.horizon);
  sketch.target = ahead.p;
  sketch.target_moves = false;
  const double fastest = kFastest * options.kind.limits.speed;
  sketch.passing = std::min(1.0, fastest / ahead.v.norm()) * ahead.v;
  return sketch;
}

SceneSketch DrawPadAhead(const SceneOptions& options, RandomStream& stream) {
  SceneSketch sketch = DrawPointAhead(options, stream);
  sketch.v_end = sketch.passing;
  sketch.passing.setZero();
  return sketch;
}

/// A wall of full height between two places of its middle line.
sim::Box Wall(const Vector3d& from, const Vector3d& to, double thickness) {
  sim::Box wall;
  const Vector3d along = to - from;
  wall.center = 0.5 * (from + to);
  wall.center.z() = 0.5 * kWallHeight;
  wall.half_extents = {0.5 * along.norm(), 0.5 * thickness, 0.5 * kWallHeight};
  wall.yaw = std::atan2(along.y(), along.x());
  return wall;
}

/// One or two walls across the way, each with a slit that is a little wider than the inflation leaves.
SceneSketch DrawSlits(const SceneOptions& options, RandomStream& stream) {
  constexpr double kWing = 8.0;  // of a wall beside its slit [m]
  SceneSketch sketch;
  const double heading = stream.Uniform(-std::numbers::pi, std::numbers::pi);
  const Vector3d ahead = Level(heading), left = Level(heading + 0.5 * std::numbers::pi);
  sketch.start.p = {stream.Uniform(-1.0, 1.0), stream.Uniform(-1.0, 1.0), kStartHeight};
  const Vector3d course = Level(heading + stream.Uniform(-0.4, 0.4));
  sketch.start.v = stream.Uniform(0.0, 0.8 * options.kind.limits.speed) * course;
  std::vector<sim::Obstacle> walls;
  const int count = stream.Uniform(0.0, 1.0) < 0.5 ? 1 : 2;
  double distance = stream.Uniform(2.5, 4.0);
  for (int i = 0; i < count; ++i, distance += stream.Uniform(2.0, 2.8)) {
    const Vector3d slit = sketch.start.p + distance * ahead + stream.Uniform(-1.5, 1.5) * left;
    const Vector3d across = Level(heading + 0.5 * std::numbers::pi + stream.Uniform(-0.5, 0.5));
    const double half = options.kind.inflation + 0.5 * stream.Uniform(0.25, 0.8);
    const double thickness = stream.Uniform(0.1, 0.5);
    walls.push_back(Wall(slit + half * across, slit + (half + kWing) * across, thickness));
    walls.push_back(Wall(slit - half * across, slit - (half + kWing) * across, thickness));
  }
  sketch.field = sim::ObstacleField(std::move(walls));
  sketch.target = sketch.start.p + options.horizon * ahead;
  LetEndCross(options, stream, &sketch);
  return sketch;
}

/// At rest in a pocket whose closed side is towards the end. Open behind, to one side, or behind but for a
/// narrow mouth.
SceneSketch DrawDeadEnd(const SceneOptions& options, RandomStream& stream) {
  SceneSketch sketch;
  const double heading = stream.Uniform(-std::numbers::pi, std::numbers::pi);
  const Vector3d ahead = Level(heading), left = Level(heading + 0.5 * std::numbers::pi);
  const double x = 0.5 * stream.Uniform(3.5, 7.0), y = 0.5 * stream.Uniform(3.5, 7.0);
  const double thickness = stream.Uniform(0.2, 0.8);
  const auto at = [&](double forward, double aside) -> Vector3d {
    return forward * ahead + aside * left;
  };
  std::vector<sim::Obstacle> walls = {Wall(at(x, -y), at(x, y), thickness),
                                      Wall(at(-x, y), at(x, y), thickness)};
  const double open = stream.Uniform(0.0, 3.0);
  if (open < 1.0) {  // to the right
    walls.push_back(Wall(at(-x, -y), at(-x, y), thickness));
  } else {
    walls.push_back(Wall(at(-x, -y), at(x, -y), thickness));
  }
  if (open >= 2.0) {
    const double mouth = 0.5 * stream.Uniform(1.6, 3.0);
    const double middle = stream.Uniform(-y + mouth, y - mouth);
    if (middle + mouth < y) walls.push_back(Wall(at(-x, middle + mouth), at(-x, y), thickness));
    if (middle - mouth > -y) walls.push_back(Wall(at(-x, -y), at(-x, middle - mouth), thickness));
  }
  sketch.field = sim::ObstacleField(std::move(walls));
  const double room = 1.0;  // from the middle of a wall [m]
  const double aside = stream.Uniform(-y + room, y - room);
  sketch.start.p = at(stream.Uniform(-x + room, x - room), aside);
  sketch.start.p.z() = kStartHeight;
  sketch.target = at(options.horizon, 0.0);
  sketch.target.z() = kStartHeight;
  LetEndCross(options, stream, &sketch);
  return sketch;
}

/// Boxes at all headings, some of which can be flown over, round pillars of all sizes, walls with gaps.
SceneSketch DrawYard(const SceneOptions& options, RandomStream& stream) {
  SceneSketch sketch;
  const double heading = stream.Uniform(-std::numbers::pi, std::numbers::pi);
  sketch.start.p = {stream.Uniform(-1.0, 1.0), stream.Uniform(-1.0, 1.0), stream.Uniform(0.6, 2.0)};
  const Vector3d course = Level(heading + stream.Uniform(-0.5, 0.5));
  sketch.start.v = stream.Uniform(0.0, 0.9 * options.kind.limits.speed) * course;
  sketch.target = sketch.start.p + options.horizon * Level(heading);
  sketch.target.z() = stream.Uniform(0.6, 2.0);
  const double speed = stream.Uniform(0.0, kFastest * options.kind.limits.speed);
  sketch.v_end = speed * Level(stream.Uniform(-std::numbers::pi, std::numbers::pi));
  const double reach = options.horizon + 3.0;
  const int things = static_cast<int>(stream.Uniform(20.0, 90.0));
  std::vector<sim::Obstacle> obstacles;
  for (int i = 0; i < things; ++i) {
    const double sort = stream.Uniform(0.0, 1.0);
    Vector3d p = Vector3d::Zero();
    p.y() = stream.Uniform(-reach, reach);
    p.x() = stream.Uniform(-reach, reach);
    const double yaw = stream.Uniform(-std::numbers::pi, std::numbers::pi);
    const double height = stream.Uniform(0.0, 1.0) < 0.4 ? stream.Uniform(0.4, 1.8) : kWallHeight;
    p.z() = 0.5 * height;
    sim::Obstacle obstacle;
    if (sort < 0.4) {
      obstacle = sim::Cylinder{p, stream.Uniform(0.05, 0.8), height};
    } else if (sort < 0.8) {
      const double across = stream.Uniform(0.1, 0.9);
      const Vector3d half(stream.Uniform(0.1, 0.9), across, 0.5 * height);
      obstacle = sim::Box{p, half, yaw};
    } else {
      const double across = stream.Uniform(0.05, 0.15);
      const Vector3d half(stream.Uniform(1.0, 3.0), across, 0.5 * height);
      obstacle = sim::Box{p, half, yaw};
    }
    constexpr double kAroundEnds = 1.2;  // around start and end [m]
    const bool in_the_way = sim::SignedDistance(obstacle, sketch.start.p) < kAroundEnds ||
                            sim::SignedDistance(obstacle, sketch.target) < 0.5 * kAroundEnds;
    if (!in_the_way) obstacles.push_back(obstacle);
  }
  sketch.field = sim::ObstacleField(std::move(obstacles));
  return sketch;
}

}  // namespace

const std::vector<SceneSet>& SceneSets() {
  static const std::vector<SceneSet> sets = {
      {"crossing", "forest; the end crosses the way with up to half the speed limit", DrawCrossing},
      {"point_ahead", "forest; a point on the straight way, passed with up to 0.9 of the limit",
       DrawPointAhead},
      {"pad_ahead", "the same point as an end that drives on with that velocity", DrawPadAhead},
      {"clutter", "as crossing, with 0.375 pillars per square metre",
       [](const SceneOptions& options, RandomStream& stream) {
         return DrawWithDensity(kClutter, options, stream);
       }},
      {"thicket", "as crossing, with 0.5 pillars per square metre",
       [](const SceneOptions& options, RandomStream& stream) {
         return DrawWithDensity(kThicket, options, stream);
       }},
      {"slits", "one or two walls, with a slit 0.25 to 0.8 m wider than the inflation", DrawSlits},
      {"dead_end", "at rest in a pocket, the end beyond its closed side", DrawDeadEnd},
      {"yard",
       "boxes, pillars and walls of all sizes; the end in any direction, up to 0.9 of the "
       "limit",
       DrawYard}};
  return sets;
}

std::vector<std::string> SceneSetNames() {
  std::vector<std::string> names;
  for (const SceneSet& set : SceneSets()) names.emplace_back(set.name);
  return names;
}

const SceneSet& SceneSetNamed(const std::string& name) {
  const auto& sets = SceneSets();
  const auto found =
      std::find_if(sets.begin(), sets.end(), [&](const SceneSet& set) { return set.name == name; });
  if (found != sets.end()) return *found;
  throw std::invalid_argument(
      fmt::format("scene set {}: the sets are {}", name, fmt::join(SceneSetNames(), ", ")));
}

}  // namespace touchdown::evaluation
