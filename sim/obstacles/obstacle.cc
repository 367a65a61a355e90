// SPDX-License-Identifier: BSD-3-Clause
// Distances and rays for boxes, cylinders and spheres, each in the obstacle's own frame. compound_shapes.cc and
// triangle_mesh.cc have the others. In its frame a box is axis-aligned and a cylinder is a rectangle in (radius, z).
// The signed distance to a rectangle or box of half extents h at a point p is
//   |max(q, 0)| + min(max_i q_i, 0) with q = |p| - h.

#include "sim/obstacles/obstacle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/base/argument_check.h"
#include "sim/obstacles/ray_intersection.h"

namespace touchdown::sim {
namespace {

constexpr double kMaxSize = 1000.0;       // [m]
constexpr double kMaxCoordinate = 1.0e5;  // [m]

void ValidateCenter(const Eigen::Vector3d& center, const std::string& name) {
  for (int axis = 0; axis < 3; ++axis) {
    estimation::CheckWithin(name + ": center." + "xyz"[axis], center[axis], -kMaxCoordinate,
                            kMaxCoordinate);
  }
}

void ValidateOne(const Box& box, const std::string& name) {
  ValidateCenter(box.center, name);
  for (int axis = 0; axis < 3; ++axis) {
    estimation::CheckAbove(name + ": half_extents." + "xyz"[axis], box.half_extents[axis], 0.0,
                           kMaxSize);
  }
  estimation::CheckWithin(name + ": yaw", box.yaw, -1.0e3, 1.0e3);
}

void ValidateOne(const Cylinder& cylinder, const std::string& name) {
  ValidateCenter(cylinder.center, name);
  estimation::CheckAbove(name + ": radius", cylinder.radius, 0.0, kMaxSize);
  estimation::CheckAbove(name + ": height", cylinder.height, 0.0, kMaxSize);
}

void ValidateOne(const Sphere& sphere, const std::string& name) {
  ValidateCenter(sphere.center, name);
  estimation::CheckAbove(name + ": radius", sphere.radius, 0.0, kMaxSize);
}

void ValidateOne(const Mesh& mesh, const std::string& name) {
  if (mesh.surface == nullptr) throw std::invalid_argument(name + ": a mesh without a surface");
  for (const Eigen::Vector3d& corner : {mesh.surface->bounds().min, mesh.surface->bounds().max}) {
    const double farthest = corner.cwiseAbs().maxCoeff();
    if (farthest <= kMaxCoordinate) continue;
    estimation::ThrowOutOfRange(name + ": greatest coordinate of its mesh [m]", farthest,
                                "[0, " + std::to_string(static_cast<int>(kMaxCoordinate)) +
                                    "]: subtract an origin near the flight from all positions");
  }
}

void ValidateOne(const VoxelColumns& columns, const std::string& name) {
  ValidateCenter(columns.corner, name);
  estimation::CheckAbove(name + ": cell", columns.cell, 0.0, kMaxSize);
  estimation::CheckWithin(name + ": count_x", columns.count_x, 1, 1000);
  estimation::CheckWithin(name + ": count_y", columns.count_y, 1, 1000);
  const double wanted = static_cast<double>(columns.count_x) * columns.count_y;
  estimation::CheckWithin(name + ": number of heights", static_cast<double>(columns.heights.size()),
                          wanted, wanted);
  for (const double height : columns.heights) {
    estimation::CheckWithin(name + ": height", height, 0.0, kMaxSize);
  }
  estimation::CheckAbove(name + ": greatest height",
                         *std::max_element(columns.heights.begin(), columns.heights.end()), 0.0,
                         kMaxSize);
}

void ValidateOne(const Ring& ring, const std::string& name) {
  ValidateCenter(ring.center, name);
  estimation::CheckAbove(name + ": half_width", ring.half_width, 0.0, kMaxSize);
  estimation::CheckAbove(name + ": half_height", ring.half_height, 0.0, kMaxSize);
  estimation::CheckAbove(name + ": tube_radius", ring.tube_radius, 0.0, kMaxSize);
  estimation::CheckWithin(name + ": yaw", ring.yaw, -1.0e3, 1.0e3);
}

double DistanceTo(const Box& box, const Eigen::Vector3d& p_W) {
  return TurnedBox(box).SignedDistance(p_W);
}

double DistanceTo(const Cylinder& cylinder, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p = p_W - cylinder.center;
  const Eigen::Vector2d q(p.head<2>().norm() - cylinder.radius,
                          std::abs(p.z()) - 0.5 * cylinder.height);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

double DistanceTo(const Sphere& sphere, const Eigen::Vector3d& p_W) {
  return (p_W - sphere.center).norm() - sphere.radius;
}

double DistanceTo(const Mesh& mesh, const Eigen::Vector3d& p_W) {
  return mesh.surface->SignedDistance(p_W);
}

double RayTo(const Box& box, const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W) {
  return TurnedBox(box).RayDistance(origin_W, direction_W);
}

double RayTo(const Cylinder& cylinder, const Eigen::Vector3d& origin_W,
             const Eigen::Vector3d& direction_W) {
  return RayCylinder(cylinder.radius, 0.5 * cylinder.height, origin_W - cylinder.center,
                     direction_W);
}

double RayTo(const Sphere& sphere, const Eigen::Vector3d& origin_W,
             const Eigen::Vector3d& direction_W) {
  return RayBall(sphere.radius, origin_W - sphere.center, direction_W);
}

double RayTo(const Mesh& mesh, const Eigen::Vector3d& origin_W,
             const Eigen::Vector3d& direction_W) {
  return mesh.surface->RayDistance(origin_W, direction_W);
}

Bounds BoundsOfOne(const Box& box) {
  const double c = std::abs(std::cos(box.yaw));
  const double s = std::abs(std::sin(box.yaw));
  const Eigen::Vector3d& h = box.half_extents;
  const Eigen::Vector3d reach(c * h.x() + s * h.y(), s * h.x() + c * h.y(), h.z());
  return {box.center - reach, box.center + reach};
}

Bounds BoundsOfOne(const Cylinder& cylinder) {
  const Eigen::Vector3d reach(cylinder.radius, cylinder.radius, 0.5 * cylinder.height);
  return {cylinder.center - reach, cylinder.center + reach};
}

Bounds BoundsOfOne(const Sphere& sphere) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius);
  return {sphere.center - reach, sphere.center + reach};
}

Bounds BoundsOfOne(const Mesh& mesh) { return mesh.surface->bounds(); }

Bounds BoundsOfOne(const VoxelColumns& columns) {
  Eigen::Array2i low(columns.count_x, columns.count_y);
  Eigen::Array2i high(0, 0);
  double top = 0.0;
  for (int y = 0; y < columns.count_y; ++y) {
    for (int x = 0; x < columns.count_x; ++x) {
      const double height = columns.heights[static_cast<std::size_t>(y * columns.count_x + x)];
      if (height <= 0.0) continue;
      low = low.min(Eigen::Array2i(x, y));
      high = high.max(Eigen::Array2i(x + 1, y + 1));
      top = std::max(top, height);
    }
  }
  return {columns.corner + columns.cell * Eigen::Vector3d(low.x(), low.y(), 0.0),
          columns.corner + Eigen::Vector3d(columns.cell * high.x(), columns.cell * high.y(), top)};
}

Bounds BoundsOfOne(const Ring& ring) {
  Bounds bounds{ring.Corner(0), ring.Corner(0)};
  for (int i = 1; i < Ring::kSides; ++i) {
    bounds.min = bounds.min.cwiseMin(ring.Corner(i));
    bounds.max = bounds.max.cwiseMax(ring.Corner(i));
  }
  bounds.min.array() -= ring.tube_radius;
  bounds.max.array() += ring.tube_radius;
  return bounds;
}

}  // namespace

TurnedBox::TurnedBox(const Box& box)
    : center_(box.center),
      half_extents_(box.half_extents),
      cos_(std::cos(box.yaw)),
      sin_(std::sin(box.yaw)) {}

Eigen::Vector3d TurnedBox::ToBox(const Eigen::Vector3d& v_W) const {
  return {cos_ * v_W.x() + sin_ * v_W.y(), -sin_ * v_W.x() + cos_ * v_W.y(), v_W.z()};
}

double TurnedBox::SignedDistance(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d q = ToBox(p_W - center_).cwiseAbs() - half_extents_;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

double TurnedBox::RayDistance(const Eigen::Vector3d& origin_W,
                              const Eigen::Vector3d& direction_W) const {
  return RayBox(half_extents_, ToBox(origin_W - center_), ToBox(direction_W));
}

void Validate(const Obstacle& obstacle, const std::string& name) {
  std::visit([&](const auto& shape) { ValidateOne(shape, name); }, obstacle);
}

void CheckGeom(const Obstacle& obstacle, const std::string& name, const std::string& user) {
  const bool columns = std::holds_alternative<VoxelColumns>(obstacle);
  if (!columns && !std::holds_alternative<Ring>(obstacle)) return;
  throw std::invalid_argument(name + " is " + (columns ? "a group of voxel columns" : "a ring") +
                              ": " + user + " takes none");
}

double SignedDistance(const Obstacle& obstacle, const Eigen::Vector3d& p_W) {
  return std::visit([&](const auto& shape) { return DistanceTo(shape, p_W); }, obstacle);
}

double RayDistance(const Obstacle& obstacle, const Eigen::Vector3d& origin_W,
                   const Eigen::Vector3d& direction_W) {
  return std::visit([&](const auto& shape) { return RayTo(shape, origin_W, direction_W); },
                    obstacle);
}

Bounds BoundsOf(const Obstacle& obstacle) {
  return std::visit([](const auto& shape) { return BoundsOfOne(shape); }, obstacle);
}

}  // namespace touchdown::sim
