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

double BriskAcceleration(double speed) {
  return std::max(sim::PadMotionConfig{}.acceleration, speed);
}

PlaygroundScene RandomScene(std::uint64_t seed) {
  constexpr double kAround = 1.4;   // of the start, and of the pad's way, nothing stands [m] ...
  constexpr double kPadWay = 20.0;  // ... for so long [s]
  constexpr int kMostDraws = 1000;  // of places
  // Draws in braces are in order with every compiler.
  sim::RandomStream stream(seed, "playground scene");
  PlaygroundScene scene;
  scene.walls.clear();
  scene.pillars.clear();
  scene.seed = seed;
  const auto& motions = PlaygroundMotions();
  const auto any = [&](double count) {
    return static_cast<std::size_t>(stream.Uniform(0.0, count));
  };
  // In hundredths, and whole degrees: people read them.
  const auto draw = [&](double low, double high) {
    return std::round(100.0 * stream.Uniform(low, high)) / 100.0;
  };
  const auto draw_angle = [&](double low_deg, double high_deg) {
    return estimation::Radians(std::round(stream.Uniform(low_deg, high_deg)));
  };
  scene.p_WB = {draw(-7.0, -5.0), draw(-3.0, 3.0), draw(1.0, 2.5)};
  scene.pad.kind = motions[any(static_cast<double>(motions.size()))].second;
  scene.pad.p_start = {draw(2.0, 6.0), draw(-3.0, 3.0), 0.3};
  scene.pad.heading = draw_angle(-180.0, 180.0);
  scene.pad.speed = draw(0.2, 1.2);
  scene.pad.acceleration = BriskAcceleration(scene.pad.speed);
  scene.pad.turn_rate = draw(0.1, 0.4);
  scene.pad.seed = seed;
  const sim::PadMotion motion(scene.pad);
  const auto is_free = [&](const Eigen::Vector2d& p, double radius) {
    bool free = (p - scene.p_WB.head<2>()).norm() > radius + kAround;
    for (double t = 0.0; free && t < kPadWay; t += 0.5) {
      free = (p - motion.At(t).p_WP.head<2>()).norm() > radius + kAround;
    }
    return free;
  };
  const auto walls = any(4.0), pillars = 2 + any(8.0);
  for (int i = 0; i < kMostDraws && scene.walls.size() < walls; ++i) {
    const Eigen::Vector2d p{draw(-4.0, 4.0), draw(-4.0, 4.0)};
    const double half = draw(0.5, 2.0), yaw = draw_angle(0.0, 180.0);
    const double height = draw(1.5, 3.5);
    if (!is_free(p, half)) continue;
    scene.walls.push_back({{p.x(), p.y(), 0.5 * height}, {half, 0.1, 0.5 * height}, yaw});
  }
  for (int i = 0; i < kMostDraws && scene.pillars.size() < pillars; ++i) {
    const Eigen::Vector2d p{draw(-4.5, 4.5), draw(-4.5, 4.5)};
    const double radius = draw(0.2, 0.6);
    if (!is_free(p, radius)) continue;
    scene.pillars.push_back({{p.x(), p.y(), 1.5}, radius, 3.0});
  }
  return scene;
}

}  // namespace touchdown::evaluation
