// SPDX-License-Identifier: BSD-3-Clause
// Shapes as attributes of MJCF geoms. No angle is written in degrees or radians, so that no
// <compiler> element can matter.

#include "sim/mujoco/mjcf_text.h"

#include <cmath>
#include <variant>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

std::string YawQuaternion(double yaw) {
  return estimation::NumberText(std::cos(0.5 * yaw)) + " 0 0 " +
         estimation::NumberText(std::sin(0.5 * yaw));
}

std::string TextOf(const Box& box) {
  return "type='box' size='" + VectorText(box.half_extents) + "' pos='" + VectorText(box.center) +
         "' quat='" + YawQuaternion(box.yaw) + "'";
}

std::string TextOf(const Cylinder& cylinder) {
  return "type='cylinder' size='" + estimation::NumberText(cylinder.radius) + ' ' +
         estimation::NumberText(0.5 * cylinder.height) + "' pos='" + VectorText(cylinder.center) +
         "' quat='1 0 0 0'";
}

std::string TextOf(const Sphere& sphere) {
  return "type='sphere' size='" + estimation::NumberText(sphere.radius) + "' pos='" +
         VectorText(sphere.center) + "'";
}

// Without its asset's name: GeomText has it.
std::string TextOf(const Mesh&) { return "type='mesh'"; }

// Refused by CheckGeom before.
std::string TextOf(const VoxelColumns&) { return ""; }
std::string TextOf(const Ring&) { return ""; }

}  // namespace

std::string VectorText(const Eigen::Vector3d& v) {
  return estimation::NumberText(v.x()) + ' ' + estimation::NumberText(v.y()) + ' ' +
         estimation::NumberText(v.z());
}

std::string GeomText(const Obstacle& obstacle, const std::string& name, const std::string& user) {
  CheckGeom(obstacle, name, user);
  const std::string text = std::visit([](const auto& shape) { return TextOf(shape); }, obstacle);
  return std::holds_alternative<Mesh>(obstacle) ? text + " mesh='" + name + "'" : text;
}

std::string MeshAssetText(const std::vector<Eigen::Vector3d>& corners,
                          const std::vector<Eigen::Vector3i>& triangles, const std::string& name) {
  std::string text = "<mesh name='" + name + "' vertex='";
  for (const Eigen::Vector3d& corner : corners) text += VectorText(corner) + ' ';
  text += "' face='";
  for (const Eigen::Vector3i& of : triangles) {
    for (const int i : of) text += std::to_string(i) + ' ';
  }
  return text + "'/>\n";
}

}  // namespace touchdown::sim
