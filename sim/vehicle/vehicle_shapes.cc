// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle_shapes.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "sim/mujoco/mujoco_model.h"

namespace touchdown::sim {
namespace {

std::optional<VehicleShape::Kind> ShapeKind(int type) {
  switch (type) {
    case mjGEOM_SPHERE:
      return VehicleShape::Kind::kSphere;
    case mjGEOM_CAPSULE:
      return VehicleShape::Kind::kCapsule;
    case mjGEOM_ELLIPSOID:
      return VehicleShape::Kind::kEllipsoid;
    case mjGEOM_CYLINDER:
      return VehicleShape::Kind::kCylinder;
    case mjGEOM_BOX:
      return VehicleShape::Kind::kBox;
    case mjGEOM_MESH:
      return VehicleShape::Kind::kMesh;
    default:
      return std::nullopt;
  }
}

void CopyMesh(const mjModel& m, int mesh, VehicleShape* shape) {
  for (int i = 0; i < m.mesh_vertnum[mesh]; ++i) {
    const float* v = m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + i);
    shape->corners.emplace_back(v[0], v[1], v[2]);
  }
  for (int i = 0; i < m.mesh_facenum[mesh]; ++i) {
    const int* f = m.mesh_face + 3 * (m.mesh_faceadr[mesh] + i);
    shape->triangles.emplace_back(f[0], f[1], f[2]);
  }
}

}  // namespace

const char* ToString(VehicleShape::Kind kind) {
  switch (kind) {
    case VehicleShape::Kind::kSphere:
      return "sphere";
    case VehicleShape::Kind::kCapsule:
      return "capsule";
    case VehicleShape::Kind::kEllipsoid:
      return "ellipsoid";
    case VehicleShape::Kind::kCylinder:
      return "cylinder";
    case VehicleShape::Kind::kBox:
      return "box";
    case VehicleShape::Kind::kMesh:
      return "mesh";
  }
  return "box";
}

std::vector<VehicleShape> VehicleShapes(const std::string& mjcf) {
  const MujocoModel model = CompileMjcf(mjcf);
  const mjModel& m = *model;
  const int body = mj_name2id(&m, mjOBJ_BODY, "vehicle");
  if (body < 0) throw std::invalid_argument("the vehicle's file lacks the body \"vehicle\"");
  std::vector<VehicleShape> shapes;
  std::optional<VehicleShape> hull;
  bool more = false;  // than hull and feet
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const float* rgba = m.geom_rgba + 4 * geom;
    const std::optional<VehicleShape::Kind> kind = ShapeKind(m.geom_type[geom]);
    if (m.geom_bodyid[geom] != body || !kind || rgba[3] == 0.0F) continue;
    VehicleShape shape;
    shape.kind = *kind;
    shape.size = Eigen::Map<const Eigen::Vector3d>(m.geom_size + 3 * geom);
    shape.p_BG = Eigen::Map<const Eigen::Vector3d>(m.geom_pos + 3 * geom);
    const mjtNum* q = m.geom_quat + 4 * geom;
    shape.q_BG = {q[0], q[1], q[2], q[3]};
    shape.rgba = Eigen::Vector4d(rgba[0], rgba[1], rgba[2], rgba[3]);
    if (*kind == VehicleShape::Kind::kMesh) CopyMesh(m, m.geom_dataid[geom], &shape);
    const std::string_view name = m.names + m.name_geomadr[geom];
    if (name == "hull") {
      hull = std::move(shape);
      continue;
    }
    more = more || !name.starts_with("foot");
    shapes.push_back(std::move(shape));
  }
  if (hull && !more) shapes.push_back(std::move(*hull));
  return shapes;
}

}  // namespace touchdown::sim
