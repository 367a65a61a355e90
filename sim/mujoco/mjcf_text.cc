// SPDX-License-Identifier: BSD-3-Clause
// Shapes as attributes of MJCF geoms. No angle is written in degrees or radians, so that no
// <compiler> element can matter.

#include "sim/mujoco/mjcf_text.h"

#include <cmath>
#include <variant>

#include "sim/base/argument_check.h"

namespace touchdown::sim {
namespace {

std::string YawQuaternion(double yaw) {
  return NumberText(std::cos(0.5 * yaw)) + " 0 0 " + NumberText(std::sin(0.5 * yaw));
}

std::string TextOf(const Box& box) {
  return "type='box' size='" + VectorText(box.half_extents) + "' pos='" + VectorText(box.center) +
         "' quat='" + YawQuaternion(box.yaw) + "'";
}

std::string TextOf(const Cylinder& cylinder) {
  return "type='cylinder' size='" + NumberText(cylinder.radius) + ' ' +
         NumberText(0.5 * cylinder.height) + "' pos='" + VectorText(cylinder.center) +
         "' quat='1 0 0 0'";
}

// Refused by CheckGeom before.
std::string TextOf(const VoxelColumns&) { return ""; }
std::string TextOf(const Ring&) { return ""; }

}  // namespace

std::string VectorText(const Eigen::Vector3d& v) {
  return NumberText(v.x()) + ' ' + NumberText(v.y()) + ' ' + NumberText(v.z());
}

std::string GeomText(const Obstacle& obstacle, const std::string& name, const std::string& user) {
  CheckGeom(obstacle, name, user);
  return std::visit([](const auto& shape) { return TextOf(shape); }, obstacle);
}

}  // namespace touchdown::sim
