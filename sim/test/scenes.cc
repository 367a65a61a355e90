// SPDX-License-Identifier: BSD-3-Clause
#include "sim/test/scenes.h"

#include <numbers>
#include <utility>
#include <vector>

namespace touchdown::sim::test {

ObstacleField RandomField(int count, double extent, RandomStream* random) {
  std::vector<Obstacle> obstacles;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center =
        RandomPoint({-extent, -extent, 0.2}, {extent, extent, 3.0}, random);
    if (i % 2 == 0) {
      const Eigen::Vector3d half_extents = RandomPoint({0.1, 0.1, 0.1}, {1.0, 1.0, 2.0}, random);
      obstacles.emplace_back(Box{center, half_extents, random->Uniform(-3.0, 3.0)});
    } else {
      obstacles.emplace_back(
          Cylinder{center, random->Uniform(0.1, 0.8), random->Uniform(0.5, 5.0)});
    }
  }
  return ObstacleField(std::move(obstacles));
}

Eigen::Vector3d RandomPoint(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                            RandomStream* random) {
  Eigen::Vector3d point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = random->Uniform(low[axis], high[axis]);
  return point;
}

Eigen::Quaterniond RandomAttitude(double max_tilt, RandomStream* random) {
  const double direction = random->Uniform(-std::numbers::pi, std::numbers::pi);
  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0.0);
  const double yaw = random->Uniform(-std::numbers::pi, std::numbers::pi);
  return Eigen::AngleAxisd(random->Uniform(0.0, max_tilt), axis) *
         Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}

WorldConfig OpenSky() {
  WorldConfig config;
  config.pad_motion.kind = PadMotionConfig::Kind::kStatic;
  config.pad_motion.p_start = {20.0, 0.0, 0.3};
  config.start.p_WB = {0.0, 0.0, 5.0};
  return config;
}

}  // namespace touchdown::sim::test
