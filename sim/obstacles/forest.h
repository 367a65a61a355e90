// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"

namespace touchdown::sim {

/// How the pillars of a forest stand.
enum class PillarShape {
  kCylinder,  ///< round, of full height: also a geom of a MuJoCo world
  kColumns,   ///< voxel columns of full height, on the lattice of the maps
  kRagged,    ///< voxel columns, each of its own height
};

/// Around here no pillar's centre and no wall may stand.
struct KeepOut {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< in W [m]
  double radius = 2.0;                               ///< [m]
};

/// A random forest: pillars, rings and walls with a gap in a rectangle centred at the origin. The
/// defaults are scene kind B.
struct ForestConfig {
  Eigen::Vector2d size = {40.0, 40.0};  ///< extent along x and y, each in [4, 1000] m
  double height = 3.0;                  ///< of pillars and walls, in (0, 100] m
  double cell = 0.1;                    ///< lattice of pillars and rings, in [0.01, 1] m
  int pillars = 200;                    ///< at most 0.5 per square metre
  PillarShape shape = PillarShape::kColumns;
  double spacing = 1.2;  ///< least distance between two pillars' centres, in [0, 10] m
  int rings = 0;
  int walls = 0;  ///< each of two boxes with a gap between them
  std::vector<KeepOut> keep_out;
};

/// The kinds of scenes EGO-Planner was measured in (simulator.xml's forest, a 40 x 40 x 3 m map):
/// - A: 200 ragged pillars and 200 rings.
/// - B: 200 pillars. C: 400 pillars. D: as B; the map has a larger inflation.
/// - `walls`: 60 walls with gaps. `dense`: 0.5 pillars per square metre, at least 0.9 m apart.
/// Throws std::invalid_argument naming the known kinds.
ForestConfig ForestOfKind(const std::string& kind);
const std::vector<std::string>& ForestKinds();

/// Sets the number of pillars to `density` per square metre, in [0, 0.5]. Sets their spacing to
/// min(1.2 m, 0.64 / sqrt(density)), because at 0.5 /m^2 pillars 1.2 m apart would not fit.
void SetDensity(double density, ForestConfig* config);

/// Draws the forest. The same (config, seed) gives the same obstacles; each kind of draw has its own random stream.
/// - A pillar has width w = U(0.5, 0.7) m, scale s = U(0.5, 1.5) and radius w s / 2. Its centre is snapped to the
///   middle of a cell.
/// - A ring has its centre at a height of U(0.7, 0.8) m. Its half axes are U(0.5, 0.7) m (horizontal) and U(0.7, 1.2) m
///   (vertical). It is turned by U(-0.5, 0.5) rad.
/// Throws std::invalid_argument naming a value out of range, or if the pillars do not fit.
ObstacleField MakeForest(const ForestConfig& config, std::uint64_t seed);

}  // namespace touchdown::sim
