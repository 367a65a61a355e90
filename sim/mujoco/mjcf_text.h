// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "sim/obstacles/obstacle.h"

namespace touchdown::sim {

/// "x y z" as an MJCF attribute takes it.
std::string VectorText(const Eigen::Vector3d& v);

/// The attributes type, size, pos and quat of an upright box or cylinder. Throws
/// std::invalid_argument, naming the obstacle as `name` and what needs it as `user`, for any other.
std::string GeomText(const Obstacle& obstacle, const std::string& name, const std::string& user);

}  // namespace touchdown::sim
