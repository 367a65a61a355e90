// SPDX-License-Identifier: BSD-3-Clause
// What several of the tests build on.
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/base/random_stream.h"
#include "sim/obstacles/obstacle_field.h"
#include "sim/world/world.h"

namespace touchdown::sim::test {

/// `count` boxes and cylinders on and above the ground within `extent` of the origin in x and y.
ObstacleField RandomField(int count, double extent, RandomStream* random);

Eigen::Vector3d RandomPoint(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                            RandomStream* random);

/// Attitude with a tilt of at most `max_tilt` [rad] and any heading.
Eigen::Quaterniond RandomAttitude(double max_tilt, RandomStream* random);

/// No obstacles, a pad that stands 20 m away, the vehicle at rest 5 m up.
WorldConfig OpenSky();

/// The message of the std::exception of type E that `call` throws; "" if it throws nothing.
template <typename E, typename Call>
std::string MessageOf(const Call& call) {
  try {
    call();
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

}  // namespace touchdown::sim::test
