// SPDX-License-Identifier: BSD-3-Clause
// Obstacles from files that other tools write.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/obstacle.h"
#include "sim/obstacles/placement.h"

namespace touchdown::sim {

/// The solids of a triangle mesh, in any format that assimp reads: OBJ, STL, PLY, DAE among others. Lengths in the file
/// times `scale` are metres.
/// @throws std::invalid_argument naming file and place: not to be read, more than 256 MiB or two million triangles, open,
/// degenerate, not finite.
std::vector<Obstacle> ObstaclesOfMeshFile(const std::string& path, double scale,
                                          const Placement& placement);

/// A solid of ground from a grey PNG of 8 or 16 bits, whose row 0 is at the greatest y. Black is 0, white is `height`
/// [m]. `size` is along x and y [m], about its frame's origin.
/// @throws std::invalid_argument naming file and what is wrong with it.
Obstacle ObstacleOfHeightFile(const std::string& path, const Eigen::Vector2d& size, double height,
                              const Placement& placement);

/// Upright boxes that fill cells of a lattice. Cell i spans [i, i + 1) times `side` [m] in the file's frame. That frame
/// is turned by `yaw` about z and stands at `p_WF`. Neighbours are joined, so there are far fewer boxes than cells.
std::vector<Obstacle> BoxesOfCells(std::vector<Eigen::Vector3i> cells, double side,
                                   const Eigen::Vector3d& p_WF, double yaw);

}  // namespace touchdown::sim
