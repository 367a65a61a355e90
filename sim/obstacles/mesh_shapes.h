// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/placement.h"
#include "sim/obstacles/triangle_mesh.h"

namespace touchdown::sim {

/// A box about the origin of its frame, of twelve triangles: for what does not stand upright.
TriangleMesh BoxMesh(const Eigen::Vector3d& half_extents, const Placement& placement);

/// Heights on a grid, between which the surface is flat in triangles.
struct HeightGrid {
  static constexpr int kMostSide = 1024;  ///< two million triangles, as a mesh
  int columns = 0, rows = 0;              ///< each in [2, kMostSide]
  std::vector<double> heights;  ///< [row * columns + column] [m]; row 0 is at the greatest y, column 0 at the least x
};

/// The ground with these heights as a solid, about the origin of its frame. `size` is along x and y [m]. Its sides
/// reach down to `thickness` below the lowest height.
/// @throws std::invalid_argument naming what is out of its range.
TriangleMesh HeightFieldMesh(const HeightGrid& grid, const Eigen::Vector2d& size, double thickness,
                             const Placement& placement);

/// The solids that triangles make up: corners at the same place are one, and triangles that share an edge are of one
/// solid. Solids may touch one another at corners, edges and faces.
/// @throws std::invalid_argument as TriangleMesh, with the triangle's index among all.
std::vector<TriangleMesh> SolidsOf(const std::vector<Eigen::Vector3d>& corners,
                                   const std::vector<Eigen::Vector3i>& triangles);

}  // namespace touchdown::sim
