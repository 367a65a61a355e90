// SPDX-License-Identifier: BSD-3-Clause
// What a user of the page has set up: plain data, and its JSON form, which the page keeps in its address.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "sim/obstacles/obstacle.h"
#include "sim/pad/pad_motion.h"
#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/planning/problem/landing_problem.h"

namespace touchdown::evaluation {

/// A scene of the page. The vehicle hovers at p_WB; its pad sets out at t = 0.
struct PlaygroundScene {
  Eigen::Vector3d p_WB = {-6.0, 0.0, 1.5};
  sim::PadMotionConfig pad;
  std::vector<sim::Box> walls;
  std::vector<sim::Cylinder> pillars;
  control::Envelope limits;
  planning::ArrivalMode arrival = planning::ArrivalMode::kFree;
  int ways = 2;  ///< around the first obstacle that are tried, 1 or 2
  std::string backend = "banded";
  bool all_known = true;  ///< else what the depth camera sees, and what is given around the start
  std::vector<std::pair<std::string, double>> weights;  ///< of terms that differ from the default
  std::uint64_t seed = 1;                               ///< of the sensors' noise, in a flight
};

/// The scene that the page begins with: a wall and three pillars in the way of a pad that drives on.
PlaygroundScene FirstScene();

/// Reads a scene. What is left out is as in FirstScene, but for walls and pillars, of which there are none then.
/// @throws std::invalid_argument naming the key, its value and what is allowed; also for a key that there is not.
PlaygroundScene SceneFrom(const nlohmann::ordered_json& json);
nlohmann::ordered_json SceneJson(const PlaygroundScene& scene);

/// 0 to 3 walls and 2 to 9 pillars between a start and a pad with a motion, all drawn. The same seed gives the same scene.
PlaygroundScene RandomScene(std::uint64_t seed);

/// From standing to its speed [m/s] within a second: a pad that stops and goes has time to [m/s^2].
double BriskAcceleration(double speed);

/// Names of the motions that a pad of the page may have.
const std::vector<std::pair<std::string, sim::PadMotionConfig::Kind>>& PlaygroundMotions();

/// The backends that the page is built with.
const std::vector<std::string>& PlaygroundBackends();

}  // namespace touchdown::evaluation
