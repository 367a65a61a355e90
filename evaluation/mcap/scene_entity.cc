// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/scene_entity.h"

#include <cstdint>

namespace touchdown::evaluation {
namespace {

void AddTriangles(protozero::pbf_writer* list, const TriangleSurface& surface) {
  for (const Eigen::Vector3d& corner : surface.corners) AddVector(list, 2, corner);
  std::vector<std::uint32_t> indices;
  for (const Eigen::Vector3i& triangle : surface.triangles) {
    for (const int corner : triangle) indices.push_back(static_cast<std::uint32_t>(corner));
  }
  list->add_packed_fixed<std::uint32_t>(5, indices.begin(), indices.end());
}

}  // namespace

SceneEntity::SceneEntity(double t, const std::string& frame, const std::string& name) {
  protozero::pbf_writer entity(bytes_);
  AddTime(&entity, 1, t);
  entity.add_string(2, frame);
  entity.add_string(3, name);
  entity.add_bool(5, true);  // it goes on with its frame after its time
}

void SceneEntity::Add(const Solid& solid) {
  constexpr unsigned kBoxes = 8, kEllipsoids = 9, kCylinders = 10, kTriangles = 12;
  protozero::pbf_writer entity(bytes_);
  const auto begin = [&](unsigned field) {
    protozero::pbf_writer part(entity, field);
    AddPose(&part, 1, solid.pose);
    return part;
  };
  switch (solid.kind) {
    case Solid::Kind::kBox:
    case Solid::Kind::kEllipsoid: {
      auto part = begin(solid.kind == Solid::Kind::kBox ? kBoxes : kEllipsoids);
      AddVector(&part, 2, solid.size);
      AddColor(&part, 3, solid.color);
      break;
    }
    case Solid::Kind::kCylinder: {
      auto part = begin(kCylinders);
      AddVector(&part, 2, solid.size);
      part.add_double(3, 1.0);  // share of the radius at the bottom, and at the top
      part.add_double(4, 1.0);
      AddColor(&part, 5, solid.color);
      break;
    }
    case Solid::Kind::kSurface: {
      auto part = begin(kTriangles);
      AddColor(&part, 3, solid.color);
      AddTriangles(&part, solid.surface);
      break;
    }
  }
}

void SceneEntity::AddLine(const std::vector<Eigen::Vector3d>& points, double thickness,
                          const Color& color, bool closed) {
  constexpr int kStrip = 0, kLoop = 1;
  protozero::pbf_writer entity(bytes_);
  protozero::pbf_writer line(entity, 11);
  line.add_enum(1, closed ? kLoop : kStrip);
  AddPose(&line, 2, Eigen::Isometry3d::Identity());
  line.add_double(3, thickness);
  for (const Eigen::Vector3d& p : points) AddVector(&line, 5, p);
  AddColor(&line, 6, color);
}

std::string SceneUpdate(const std::vector<SceneEntity>& entities) {
  std::string bytes;
  protozero::pbf_writer update(bytes);
  for (const SceneEntity& entity : entities) update.add_message(2, entity.bytes());
  return bytes;
}

}  // namespace touchdown::evaluation
