// SPDX-License-Identifier: BSD-3-Clause
#include "sim/obstacles/mesh_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

// Sets of things that hang together: the root of a thing's set.
int RootOf(int thing, std::vector<int>* parents) {
  auto& up = *parents;
  const auto at = [&](int i) -> int& { return up[static_cast<std::size_t>(i)]; };
  while (at(thing) != thing) thing = at(thing) = at(at(thing));
  return thing;
}

// A triangle at an edge: its direction along the edge, and its angle about it.
struct Side {
  int triangle = 0;
  bool forth = false;  // from the edge's lower corner to the higher one
  double angle = 0.0;  // about the edge [rad]
};

using Edge = std::pair<int, int>;

std::map<Edge, std::vector<Side>> SidesOfEdges(const std::vector<Eigen::Vector3d>& corners,
                                               const std::vector<Eigen::Vector3i>& triangles) {
  std::map<Edge, std::vector<Side>> edges;
  const auto at = [&](int i) -> const Eigen::Vector3d& { return corners[static_cast<std::size_t>(i)]; };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int from = triangles[t][k], to = triangles[t][(k + 1) % 3], third = triangles[t][(k + 2) % 3];
      const Edge edge = std::minmax(from, to);
      const Eigen::Vector3d along = (at(edge.second) - at(edge.first)).normalized();
      const Eigen::Vector3d across = along.unitOrthogonal(), off = at(third) - at(edge.first);
      edges[edge].push_back({static_cast<int>(t), from < to,
                             std::atan2(off.dot(along.cross(across)), off.dot(across))});
    }
  }
  return edges;
}

// Where two solids touch face to face, one ends before the other begins.
void SortAbout(std::vector<Side>* sides) {
  constexpr double kSame = 1e-6;  // angles of faces in one plane [rad]
  const auto grid = [](const Side& side) {
    const auto turns = std::lround(side.angle / kSame), half = std::lround(std::numbers::pi / kSame);
    return turns >= half ? turns - 2 * half : turns;
  };
  std::sort(sides->begin(), sides->end(), [&](const Side& a, const Side& b) {
    return std::tuple(grid(a), !a.forth, a.triangle) < std::tuple(grid(b), !b.forth, b.triangle);
  });
}

}  // namespace

Eigen::Matrix3d TurnOf(double roll, double pitch, double yaw) {
  return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

TriangleMesh BoxMesh(const Eigen::Vector3d& half_extents, const Placement& placement) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {  // bit by axis
    const Eigen::Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    corners.push_back(placement(half_extents.cwiseProduct(sign)));
  }
  return {std::move(corners),
          {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
           {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}}};
}

TriangleMesh HeightFieldMesh(const HeightGrid& grid, const Eigen::Vector2d& size, double thickness,
                             const Placement& placement) {
  estimation::CheckWithin("height field: columns", grid.columns, 2, HeightGrid::kMostSide);
  estimation::CheckWithin("height field: rows", grid.rows, 2, HeightGrid::kMostSide);
  const double wanted = static_cast<double>(grid.columns) * grid.rows;
  estimation::CheckWithin("height field: number of heights",
                          static_cast<double>(grid.heights.size()), wanted, wanted);
  estimation::CheckAbove("height field: size along x [m]", size.x(), 0.0, 1000.0);
  estimation::CheckAbove("height field: size along y [m]", size.y(), 0.0, 1000.0);
  estimation::CheckAbove("height field: thickness [m]", thickness, 0.0, 1000.0);
  for (const double height : grid.heights) {
    estimation::CheckWithin("height field: height [m]", height, -1000.0, 1000.0);
  }
  const int nx = grid.columns, ny = grid.rows;
  const double bottom = *std::min_element(grid.heights.begin(), grid.heights.end()) - thickness;
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3i> triangles;
  const auto place = [&](int column, int row) {
    return Eigen::Vector2d(size.x() * (column / (nx - 1.0) - 0.5), size.y() * (0.5 - row / (ny - 1.0)));
  };
  const auto top = [&](int column, int row) { return row * nx + column; };
  for (int row = 0; row < ny; ++row) {
    for (int column = 0; column < nx; ++column) {
      const Eigen::Vector2d xy = place(column, row);
      corners.push_back(placement(
          {xy.x(), xy.y(), grid.heights[static_cast<std::size_t>(top(column, row))]}));
    }
  }
  for (int row = 0; row + 1 < ny; ++row) {
    for (int column = 0; column + 1 < nx; ++column) {
      const int a = top(column, row), b = top(column + 1, row);
      const int c = top(column, row + 1), d = top(column + 1, row + 1);
      triangles.insert(triangles.end(), {{a, c, b}, {b, c, d}});
    }
  }
  // Around the rim against the clock, seen from above.
  std::vector<std::pair<int, int>> rim;
  for (int column = 0; column + 1 < nx; ++column) rim.emplace_back(column, ny - 1);
  for (int row = ny - 1; row > 0; --row) rim.emplace_back(nx - 1, row);
  for (int column = nx - 1; column > 0; --column) rim.emplace_back(column, 0);
  for (int row = 0; row + 1 < ny; ++row) rim.emplace_back(0, row);
  const int count = static_cast<int>(rim.size());
  const int first = static_cast<int>(corners.size()), middle = first + count;
  for (const auto& [column, row] : rim) {
    const Eigen::Vector2d xy = place(column, row);
    corners.push_back(placement({xy.x(), xy.y(), bottom}));
  }
  corners.push_back(placement({0.0, 0.0, bottom}));
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    const auto up = [&](int k) {
      return top(rim[static_cast<std::size_t>(k)].first, rim[static_cast<std::size_t>(k)].second);
    };
    triangles.insert(triangles.end(), {{up(i), first + i, up(next)},
                                       {up(next), first + i, first + next},
                                       {first + next, first + i, middle}});
  }
  return {std::move(corners), std::move(triangles)};
}

std::vector<TriangleMesh> SolidsOf(const std::vector<Eigen::Vector3d>& corners,
                                   const std::vector<Eigen::Vector3i>& triangles) {
  std::map<std::array<double, 3>, int> places;
  std::vector<int> one(corners.size());  // the first corner at the same place
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& p = corners[i];
    if (!p.allFinite()) {
      throw std::invalid_argument("corner " + std::to_string(i) + " is not finite");
    }
    const auto [found, is_new] =
        places.emplace(std::array{p.x(), p.y(), p.z()}, static_cast<int>(kept.size()));
    if (is_new) kept.push_back(p);
    one[i] = found->second;
  }
  std::vector<Eigen::Vector3i> joined;
  for (const Eigen::Vector3i& of : triangles) {
    for (const int i : of) {
      if (i < 0 || i >= static_cast<int>(corners.size())) {
        throw std::invalid_argument("triangle " + std::to_string(joined.size()) + " has corner " +
                                    std::to_string(i) + " of " + std::to_string(corners.size()));
      }
    }
    joined.emplace_back(one[static_cast<std::size_t>(of[0])], one[static_cast<std::size_t>(of[1])],
                        one[static_cast<std::size_t>(of[2])]);
  }
  if (SignedVolume(kept, joined) < 0.0) {
    for (Eigen::Vector3i& of : joined) std::swap(of[1], of[2]);
  }
  std::vector<int> parents(joined.size());  // of triangles
  std::iota(parents.begin(), parents.end(), 0);
  for (auto& [edge, sides] : SidesOfEdges(kept, joined)) {
    SortAbout(&sides);
    // The solid is between a triangle that runs back along the edge and the next one that runs forth.
    const std::size_t count = sides.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Side& next = sides[(i + 1) % count];
      if (sides[i].forth || !next.forth) continue;
      parents[static_cast<std::size_t>(RootOf(sides[i].triangle, &parents))] =
          RootOf(next.triangle, &parents);
    }
  }
  struct Solid {
    std::vector<Eigen::Vector3d> corners;
    std::vector<Eigen::Vector3i> triangles;
    std::map<int, int> index;  // of a corner among its own
  };
  std::vector<Solid> solids;
  std::vector<int> solid_of(joined.size(), -1);
  for (std::size_t t = 0; t < joined.size(); ++t) {
    int& solid = solid_of[static_cast<std::size_t>(RootOf(static_cast<int>(t), &parents))];
    if (solid < 0) {
      solid = static_cast<int>(solids.size());
      solids.emplace_back();
    }
    Solid& to = solids[static_cast<std::size_t>(solid)];
    Eigen::Vector3i renamed;
    for (int k = 0; k < 3; ++k) {
      const int corner = joined[t][k];
      const auto [found, is_new] = to.index.emplace(corner, static_cast<int>(to.corners.size()));
      if (is_new) to.corners.push_back(kept[static_cast<std::size_t>(corner)]);
      renamed[k] = found->second;
    }
    to.triangles.push_back(renamed);
  }
  std::vector<TriangleMesh> meshes;
  std::vector<std::pair<Eigen::Vector3d, std::size_t>> inward;  // a corner of such a surface, its index
  for (Solid& solid : solids) {
    if (SignedVolume(solid.corners, solid.triangles) < 0.0) {
      inward.emplace_back(solid.corners.front(), meshes.size());
    }
    meshes.emplace_back(std::move(solid.corners), std::move(solid.triangles));
  }
  // A surface that faces inwards is a cavity if it is within another one. Elsewhere it is turned the wrong way.
  for (const auto& [corner, index] : inward) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      if (i == index || meshes[i].SignedDistance(corner) >= 0.0) continue;
      throw std::invalid_argument("the surface at " + PlaceText(corner) +
                                  " is a cavity within another solid: cut it open or leave it out");
    }
  }
  return meshes;
}

}  // namespace touchdown::sim
