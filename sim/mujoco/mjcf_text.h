// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/obstacle.h"

namespace touchdown::sim {

/// "x y z" as an MJCF attribute takes it.
std::string VectorText(const Eigen::Vector3d& v);

/// The attributes type, size, pos and quat of an obstacle; of a mesh its asset, which has its `name`
/// (MeshAssetText). Throws std::invalid_argument as CheckGeom.
std::string GeomText(const Obstacle& obstacle, const std::string& name, const std::string& user);

/// A mesh as an asset: its corners [m], and per triangle the indices of its three.
std::string MeshAssetText(const std::vector<Eigen::Vector3d>& corners,
                          const std::vector<Eigen::Vector3i>& triangles, const std::string& name);

}  // namespace touchdown::sim
