// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle_shapes.h"

#include <mujoco/mujoco.h>

#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

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

// Nothing for an invisible geom: it is wholly transparent, or in a group that MuJoCo's viewer does not show.
std::optional<VehicleShape> ShapeOfGeom(const mjModel& m, int geom) {
  constexpr int kLastShown = 2;
  const float* rgba = m.geom_rgba + 4 * geom;
  const std::optional<VehicleShape::Kind> kind = ShapeKind(m.geom_type[geom]);
  if (!kind || rgba[3] == 0.0F || m.geom_group[geom] > kLastShown) return std::nullopt;
  VehicleShape shape;
  shape.kind = *kind;
  shape.size = Eigen::Map<const Eigen::Vector3d>(m.geom_size + 3 * geom);
  shape.p_BG = Eigen::Map<const Eigen::Vector3d>(m.geom_pos + 3 * geom);
  const mjtNum* q = m.geom_quat + 4 * geom;
  shape.q_BG = {q[0], q[1], q[2], q[3]};
  shape.rgba = Eigen::Vector4d(rgba[0], rgba[1], rgba[2], rgba[3]);
  if (*kind == VehicleShape::Kind::kMesh) CopyMesh(m, m.geom_dataid[geom], &shape);
  return shape;
}

// From B's origin, unless it ends there too.
void AddArm(const Eigen::Vector3d& end_B, std::vector<VehicleShape>* shapes) {
  constexpr double kThickness = 0.06;  // its radius over its length
  constexpr double kShortest = 1e-3;   // [m]
  const double length = end_B.norm();
  if (length < kShortest) return;
  VehicleShape arm;
  arm.kind = VehicleShape::Kind::kCapsule;
  arm.size = {kThickness * length, 0.5 * length, 0.0};
  arm.p_BG = 0.5 * end_B;
  arm.q_BG = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), end_B);
  arm.rgba = {0.16, 0.17, 0.20, 1.0};
  shapes->push_back(std::move(arm));
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
  const MujocoModel model = CompileVehicleMjcf(mjcf);
  const mjModel& m = *model;
  const int body = mj_name2id(&m, mjOBJ_BODY, "vehicle");
  if (body < 0) throw std::invalid_argument("the vehicle's file lacks the body \"vehicle\"");
  std::vector<VehicleShape> shapes;
  bool has_frame = false;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const std::string_view name = m.names + m.name_geomadr[geom];
    const std::optional<VehicleShape> shape = ShapeOfGeom(m, geom);
    if (m.geom_bodyid[geom] != body || name == "hull" || !shape) continue;
    has_frame = has_frame || !name.starts_with("foot");
    shapes.push_back(*shape);
  }
  if (has_frame) return shapes;
  for (std::size_t foot = 0, feet = shapes.size(); foot < feet; ++foot) {
    const Eigen::Vector3d end_B = shapes[foot].p_BG;  // the list grows
    AddArm(end_B, &shapes);
  }
  for (int site = 0; site < m.nsite; ++site) {
    const std::string_view name = m.names + m.name_siteadr[site];
    if (m.site_bodyid[site] != body || !name.starts_with("rotor")) continue;
    AddArm(Eigen::Map<const Eigen::Vector3d>(m.site_pos + 3 * site), &shapes);
  }
  return shapes;
}

double DrawnRotorRadius(const estimation::VehicleModel& model) {
  constexpr double kUnknown = 0.1;
  return model.rotor_radius > 0.0 ? model.rotor_radius : kUnknown;
}

}  // namespace touchdown::sim
