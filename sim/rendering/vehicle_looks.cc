// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/vehicle_looks.h"

#include <sstream>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mjcf_text.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/vehicle/vehicle_shapes.h"

namespace touchdown::sim {
namespace {

constexpr char kDiscColor[] = "0.75 0.86 0.97 0.38";
constexpr double kDiscHeight = 0.004;  // half of it [m]

std::string QuaternionText(const Eigen::Quaterniond& q) {
  return estimation::NumberText(q.w()) + ' ' + VectorText(q.vec());
}

std::string ColorText(const Eigen::Vector4d& rgba) {
  return VectorText(rgba.head<3>()) + ' ' + estimation::NumberText(rgba[3]);
}

void AddShape(const VehicleShape& shape, const std::string& name, VehicleLooks* looks) {
  std::ostringstream xml;
  xml << "<geom type='" << ToString(shape.kind) << "' ";
  if (shape.kind == VehicleShape::Kind::kMesh) {
    looks->assets += MeshAssetText(shape.corners, shape.triangles, name);
    xml << "mesh='" << name << "' ";
  } else {
    xml << "size='" << VectorText(shape.size) << "' ";
  }
  xml << "pos='" << VectorText(shape.p_BG) << "' quat='" << QuaternionText(shape.q_BG) << "' rgba='"
      << ColorText(shape.rgba) << "'/>\n";
  looks->geoms += xml.str();
}

void AddDisc(const Eigen::Vector3d& p_BR, double radius, VehicleLooks* looks) {
  looks->geoms.append("<geom type='cylinder' size='")
      .append(VectorText({radius, kDiscHeight, 0.0}))
      .append("' pos='")
      .append(VectorText(p_BR))
      .append("' rgba='")
      .append(kDiscColor)
      .append("'/>\n");
}

}  // namespace

VehicleLooks LooksOf(const std::string& vehicle_mjcf) {
  VehicleLooks looks;
  int shapes = 0;
  for (const VehicleShape& shape : VehicleShapes(vehicle_mjcf)) {
    AddShape(shape, "vehicle " + std::to_string(shapes++), &looks);
  }
  const estimation::VehicleModel model = LoadVehicleModel(vehicle_mjcf);
  const double radius = DrawnRotorRadius(model);
  for (const estimation::Actuator& actuator : model.actuators) {
    // What makes a moment alone has no place.
    if (actuator.thrust != 0.0) AddDisc(actuator.p_BR, radius, &looks);
  }
  return looks;
}

}  // namespace touchdown::sim
