// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/playground/scene.h"

#include <algorithm>
#include <cmath>

#include "estimation/base/degrees.h"
#include "sim/base/random_stream.h"

namespace touchdown::evaluation {

PlaygroundScene FirstScene() {
  PlaygroundScene scene;
  scene.pad.kind = sim::PadMotionConfig::Kind::kLine;
  scene.pad.p_start = {4.0, -2.0, 0.3};
  scene.pad.heading = 0.5 * M_PI;
  scene.pad.speed = 0.6;
  scene.walls = {{{-1.0, 0.2, 1.5}, {0.15, 1.6, 1.5}, 0.0}};
  scene.pillars = {
      {{-3.4, 1.7, 1.5}, 0.35, 3.0}, {{1.8, -2.4, 1.5}, 0.4, 3.0}, {{2.2, 2.3, 1.5}, 0.4, 3.0}};
  return scene;
}

const std::vector<std::pair<std::string, sim::PadMotionConfig::Kind>>& PlaygroundMotions() {
  using Kind = sim::PadMotionConfig::Kind;
  static const std::vector<std::pair<std::string, Kind>> kMotions = {
      {"static", Kind::kStatic},
      {"line", Kind::kLine},
      {"circle", Kind::kCircle},
      {"straight_turn", Kind::kStraightTurn},
      {"figure_eight", Kind::kFigureEight},
      {"stop_and_go", Kind::kStopAndGo},
      {"reversing", Kind::kReversing},
      {"random", Kind::kRandom}};
  return kMotions;
}

const std::vector<std::string>& PlaygroundBackends() {
  static const std::vector<std::string> kBackends = {"banded", "lbfgs"};
  return kBackends;
}

PlaygroundScene RandomScene(std::uint64_t seed) {
  constexpr double kAround = 1.4;   // of start and pad nothing stands [m]
  constexpr int kMostDraws = 1000;  // of places
  sim::RandomStream stream(seed, "playground scene");
  PlaygroundScene scene;
  scene.walls.clear();
  scene.pillars.clear();
  scene.seed = seed;
  scene.p_WB = {stream.Uniform(-7.0, -5.0), stream.Uniform(-3.0, 3.0), stream.Uniform(1.0, 2.5)};
  const auto& motions = PlaygroundMotions();
  const auto any = [&](double count) {
    return static_cast<std::size_t>(stream.Uniform(0.0, count));
  };
  scene.pad.kind = motions[any(static_cast<double>(motions.size()))].second;
  scene.pad.p_start = {stream.Uniform(2.0, 6.0), stream.Uniform(-3.0, 3.0), 0.3};
  scene.pad.heading = stream.Uniform(-M_PI, M_PI);
  scene.pad.speed = stream.Uniform(0.2, 1.2);
  scene.pad.turn_rate = stream.Uniform(0.1, 0.4);
  scene.pad.seed = seed;
  const auto is_free = [&](const Eigen::Vector2d& p, double radius) {
    return (p - scene.p_WB.head<2>()).norm() > radius + kAround &&
           (p - scene.pad.p_start.head<2>()).norm() > radius + kAround;
  };
  const auto walls = any(4.0), pillars = 2 + any(8.0);
  for (int draw = 0; draw < kMostDraws && scene.walls.size() < walls; ++draw) {
    const Eigen::Vector2d p(stream.Uniform(-4.0, 4.0), stream.Uniform(-4.0, 4.0));
    const double half = stream.Uniform(0.5, 2.0), yaw = stream.Uniform(0.0, M_PI);
    const double height = stream.Uniform(1.5, 3.5);
    if (!is_free(p, half)) continue;
    scene.walls.push_back({{p.x(), p.y(), 0.5 * height}, {half, 0.1, 0.5 * height}, yaw});
  }
  for (int draw = 0; draw < kMostDraws && scene.pillars.size() < pillars; ++draw) {
    const Eigen::Vector2d p(stream.Uniform(-4.5, 4.5), stream.Uniform(-4.5, 4.5));
    const double radius = stream.Uniform(0.2, 0.6);
    if (!is_free(p, radius)) continue;
    scene.pillars.push_back({{p.x(), p.y(), 1.5}, radius, 3.0});
  }
  return scene;
}

}  // namespace touchdown::evaluation
