// SPDX-License-Identifier: BSD-3-Clause
// Cells against dense samples of the obstacles' signed distance.
#include "evaluation/flight/field_map.h"

#include <memory>

#include <gtest/gtest.h>

#include "sim/base/random_stream.h"
#include "sim/obstacles/forest.h"
#include "sim/obstacles/mesh_shapes.h"

namespace touchdown::evaluation {
namespace {

using planning::CellIndex;
using planning::OccupancyMap;

OccupancyMap EmptyMap() {
  planning::OccupancyMapOptions options;
  options.size_log2 = {6, 6, 5};
  options.inflation_radius = 0.0;
  return OccupancyMap(options);
}

template <class Visit>
void ForEachCell(const OccupancyMap& map, Visit&& visit) {
  const CellIndex end = map.origin() + map.size();
  CellIndex c;
  for (c.z() = map.origin().z(); c.z() < end.z(); ++c.z()) {
    for (c.y() = map.origin().y(); c.y() < end.y(); ++c.y()) {
      for (c.x() = map.origin().x(); c.x() < end.x(); ++c.x()) visit(c);
    }
  }
}

// Least signed distance over a lattice of points of the cell.
double NearestInCell(const sim::ObstacleField& field, const Eigen::Vector3d& centre, double size) {
  constexpr int kSteps = 4;
  double nearest = 1e9;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const Eigen::Vector3d off(i, j, k);
        const Eigen::Vector3d p = centre + size * (off / kSteps - Eigen::Vector3d::Constant(0.5));
        nearest = std::min(nearest, field.SignedDistance(p));
      }
    }
  }
  return nearest;
}

TEST(FieldMap, CellsThatMeetAnObstacleAreOccupiedAndNoOthers) {
  sim::RandomStream random(4, "field map test");
  for (int scene = 0; scene < 2; ++scene) {
    const auto place = [&] {
      const double x = random.Uniform(-2.0, 2.0);
      const double y = random.Uniform(-2.0, 2.0);
      return Eigen::Vector3d(x, y, random.Uniform(-0.5, 0.5));
    };
    sim::VoxelColumns columns;
    columns.corner = place();
    columns.cell = 0.23;
    columns.count_x = 2;
    columns.count_y = 2;
    columns.heights = {0.4, 0.0, 0.7, 0.2};
    const sim::ObstacleField field({
        sim::Box{place(), {0.5, 0.2, 0.3}, random.Uniform(-3.0, 3.0)},
        sim::Cylinder{place(), 0.37, 0.9},
        columns,
        sim::Ring{place(), 0.5, 0.6, 0.06, random.Uniform(-3.0, 3.0)},
        sim::Sphere{place(), 0.45},
        sim::Mesh{std::make_shared<const sim::TriangleMesh>(
            sim::BoxMesh({0.5, 0.3, 0.2}, {sim::TurnOf(0.4, 0.3, 0.2), place()}))},
    });
    OccupancyMap map = EmptyMap();
    FillMap(field, &map);
    int occupied = 0;
    ForEachCell(map, [&](const CellIndex& cell) {
      const double to_centre = field.SignedDistance(map.CentreOf(cell));
      const bool near = to_centre < 0.12;  // half a diagonal is 0.087
      const double nearest =
          near ? NearestInCell(field, map.CentreOf(cell), map.resolution()) : to_centre;
      const bool is = map.IsOccupied(cell);
      occupied += is;
      EXPECT_TRUE(map.IsKnown(cell));
      EXPECT_EQ(map.IsObservedFree(cell), !is);
      // A point of the lattice inside: it meets. None within a lattice step: it does not.
      if (nearest < -1e-6) {
        EXPECT_TRUE(is) << map.CentreOf(cell).transpose();
      }
      if (nearest > 0.025) {
        EXPECT_FALSE(is) << map.CentreOf(cell).transpose();
      }
    });
    EXPECT_GT(occupied, 300);
  }
}

// Voxel columns on the map's own lattice touch their neighbours' cells but do not meet them.
TEST(FieldMap, AForestFillsExactlyItsColumns) {
  sim::ForestConfig config = sim::ForestOfKind("B");
  config.size = {6.0, 6.0};
  config.pillars = 8;
  const sim::ObstacleField forest = sim::MakeForest(config, 3);
  planning::OccupancyMapOptions options;
  options.size_log2 = {7, 7, 6};
  OccupancyMap map(options);
  FillMap(forest, &map);
  int columns = 0;
  for (const sim::Obstacle& obstacle : forest.obstacles()) {
    for (const double height : std::get<sim::VoxelColumns>(obstacle).heights) columns += height > 0;
  }
  int occupied = 0;
  ForEachCell(map, [&](const CellIndex& cell) { occupied += map.IsOccupied(cell); });
  EXPECT_EQ(occupied, columns * 30);  // 3 m
}

}  // namespace
}  // namespace touchdown::evaluation
