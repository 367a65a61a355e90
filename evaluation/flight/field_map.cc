// SPDX-License-Identifier: BSD-3-Clause
// Cell against obstacle. Each test is exact:
// - a turned box by separating axes in the plane;
// - a cylinder by the point of the cell nearest to its axis, a sphere by the one nearest to its centre;
// - a mesh by its triangles, a column by its interval on each axis;
// - a side of a ring by the distance from its segment to the cell, a convex function along the segment.
#include "evaluation/flight/field_map.h"

#include <algorithm>
#include <cmath>

#include <boost/math/tools/minima.hpp>

namespace touchdown::evaluation {
namespace {

constexpr double kTouch = 1e-9;  // contact of surfaces is no overlap [m]

using planning::CellIndex;
using planning::OccupancyMap;

/// Occupies the cells that overlap the bounds and for which meets(cell's centre) holds.
template <class Meets>
void MarkCells(const sim::Bounds& bounds, OccupancyMap* map, Meets&& meets) {
  const Eigen::Vector3d inner = Eigen::Vector3d::Constant(kTouch);
  const CellIndex low = map->CellOf(bounds.min + inner).cwiseMax(map->origin());
  const CellIndex high =
      map->CellOf(bounds.max - inner).cwiseMin(map->origin() + map->size() - CellIndex::Ones());
  CellIndex cell;
  for (cell.z() = low.z(); cell.z() <= high.z(); ++cell.z()) {
    for (cell.y() = low.y(); cell.y() <= high.y(); ++cell.y()) {
      for (cell.x() = low.x(); cell.x() <= high.x(); ++cell.x()) {
        const Eigen::Vector3d centre = map->CentreOf(cell);
        if (!map->IsOccupied(cell) && meets(centre)) map->SetOccupied(centre);
      }
    }
  }
}

void Mark(const sim::Box& box, OccupancyMap* map) {
  const double half = 0.5 * map->resolution();
  const double c = std::cos(box.yaw);
  const double s = std::sin(box.yaw);
  // The box's bounds have settled the cell's own axes. Only the box's axes are tested here.
  const double reach = half * (std::abs(c) + std::abs(s)) - kTouch;
  MarkCells(sim::BoundsOf(box), map, [&](const Eigen::Vector3d& centre) {
    const Eigen::Vector3d d = centre - box.center;
    return std::abs(c * d.x() + s * d.y()) < box.half_extents.x() + reach &&
           std::abs(-s * d.x() + c * d.y()) < box.half_extents.y() + reach;
  });
}

void Mark(const sim::Cylinder& cylinder, OccupancyMap* map) {
  const double half = 0.5 * map->resolution();
  MarkCells(sim::BoundsOf(cylinder), map, [&](const Eigen::Vector3d& centre) {
    const Eigen::Array2d off = (centre - cylinder.center).head<2>().array().abs();
    return (off - half).max(0.0).matrix().norm() < cylinder.radius - kTouch;
  });
}

void Mark(const sim::Sphere& sphere, OccupancyMap* map) {
  const double half = 0.5 * map->resolution();
  MarkCells(sim::BoundsOf(sphere), map, [&](const Eigen::Vector3d& centre) {
    const Eigen::Array3d off = (centre - sphere.center).array().abs();
    return (off - half).max(0.0).matrix().norm() < sphere.radius - kTouch;
  });
}

void Mark(const sim::Mesh& mesh, OccupancyMap* map) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * map->resolution() - kTouch);
  MarkCells(mesh.surface->bounds(), map, [&](const Eigen::Vector3d& centre) {
    return mesh.surface->Meets({centre - half, centre + half});
  });
}

void Mark(const sim::VoxelColumns& columns, OccupancyMap* map) {
  for (int y = 0; y < columns.count_y; ++y) {
    for (int x = 0; x < columns.count_x; ++x) {
      const double height = columns.heights[static_cast<std::size_t>(y * columns.count_x + x)];
      if (height <= 0.0) continue;
      const Eigen::Vector3d low = columns.corner + columns.cell * Eigen::Vector3d(x, y, 0.0);
      MarkCells({low, low + Eigen::Vector3d(columns.cell, columns.cell, height)}, map,
                [](const Eigen::Vector3d&) { return true; });
    }
  }
}

void Mark(const sim::Ring& ring, OccupancyMap* map) {
  const double half = 0.5 * map->resolution();
  constexpr int kBits = 20;  // of the minimiser's place: 1e-6 of a side
  for (int i = 0; i < sim::Ring::kSides; ++i) {
    const Eigen::Vector3d a = ring.Corner(i);
    const Eigen::Vector3d b = ring.Corner(i + 1);
    const sim::Bounds bounds{a.cwiseMin(b).array() - ring.tube_radius,
                             a.cwiseMax(b).array() + ring.tube_radius};
    MarkCells(bounds, map, [&](const Eigen::Vector3d& centre) {
      const auto to_cell = [&](double s) {
        const Eigen::Array3d off = (a + s * (b - a) - centre).array().abs();
        return (off - half).max(0.0).matrix().norm();
      };
      const double nearest =
          std::min({to_cell(0.0), to_cell(1.0),
                    boost::math::tools::brent_find_minima(to_cell, 0.0, 1.0, kBits).second});
      return nearest < ring.tube_radius - kTouch;
    });
  }
}

}  // namespace

void FillMap(const sim::ObstacleField& field, planning::OccupancyMap* map) {
  for (const sim::Obstacle& obstacle : field.obstacles()) {
    std::visit([&](const auto& shape) { Mark(shape, map); }, obstacle);
  }
  map->MarkRestFree();
}

}  // namespace touchdown::evaluation
