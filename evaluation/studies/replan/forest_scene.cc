// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/forest_scene.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "sim/obstacles/forest.h"

namespace touchdown::evaluation {
namespace {

constexpr double kCruiseHeight = 1.0;  // of start and goal [m]
constexpr double kAroundStart = 2.0;   // of pillars around start and goal [m]
constexpr double kSquare = 8.0;        // half side of the square of starts [m]
constexpr double kGoal = 11.0 / 7.5;   // of the horizon

}  // namespace

const std::vector<SceneKind>& SceneKinds() {
  static const std::vector<SceneKind> kinds = {{"A", "A", {2.0, 3.0}, 0.1},
                                               {"B", "B", {2.0, 3.0}, 0.1},
                                               {"C", "C", {3.0, 6.0}, 0.1},
                                               {"D", "B", {3.0, 6.0}, 0.3}};
  return kinds;
}

const SceneKind& SceneKindNamed(const std::string& name) {
  for (const SceneKind& kind : SceneKinds()) {
    if (kind.name == name) return kind;
  }
  throw std::invalid_argument(fmt::format("scene kind {}: the kinds are A, B, C and D", name));
}

sim::RandomStream SceneStream(const SceneOptions& options, int index, int draw) {
  return sim::RandomStream(options.seed, fmt::format("replan scene {} {}", index, draw));
}

ForestScene DrawForestScene(const SceneOptions& options, sim::RandomStream* stream) {
  ForestScene scene;
  const double x = stream->Uniform(-kSquare, kSquare);
  const double y = stream->Uniform(-kSquare, kSquare);
  const double heading = stream->Uniform(-std::numbers::pi, std::numbers::pi);
  const double speed = stream->Uniform(0.0, 0.8 * options.kind.limits.speed);
  const double course = heading + stream->Uniform(-0.4, 0.4);
  scene.start.p = {x, y, kCruiseHeight};
  scene.start.v = speed * Eigen::Vector3d(std::cos(course), std::sin(course), 0.0);
  scene.ahead = {std::cos(heading), std::sin(heading), 0.0};
  const double distance = kGoal * options.horizon;
  scene.goal = scene.start.p + distance * scene.ahead;

  sim::ForestConfig forest = sim::ForestOfKind(options.kind.forest);
  // The published forest reaches a metre beyond the farthest goal.
  const double density =
      options.density > 0.0 ? options.density : forest.pillars / forest.size.prod();
  const double rings = forest.rings / forest.size.prod();
  forest.size = forest.size.cwiseMax(2.0 * (kSquare + distance + 1.0));
  forest.rings = static_cast<int>(std::lround(rings * forest.size.prod()));
  sim::SetDensity(density, &forest);
  forest.keep_out = {{scene.start.p.head<2>(), kAroundStart}, {scene.goal.head<2>(), kAroundStart}};
  scene.height = forest.height;
  scene.field = sim::MakeForest(forest, stream->Seed());
  return scene;
}

estimation::VehicleModel PointVehicle() {
  estimation::VehicleModel point;
  point.hull_radius = point.hull_top = point.foot_depth = kPointRadius;
  return point;
}

}  // namespace touchdown::evaluation
