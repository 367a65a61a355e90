// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle_outline.h"

#include <mujoco/mujoco.h>

#include <cmath>
#include <numbers>

#include "sim/mujoco/mujoco_call.h"

namespace touchdown::sim {
namespace {

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using MapVector3d = Eigen::Map<const Eigen::Vector3d>;

}  // namespace

std::vector<Eigen::Vector3d> PointsAround(const mjModel& m, const mjData& d, int geom) {
  const MapVector3d p(d.geom_xpos + 3 * geom);
  const Eigen::Map<const RowMajor3d> R(d.geom_xmat + 9 * geom);
  std::vector<Eigen::Vector3d> points;
  const auto hold = [&](const Eigen::Vector3d& q) { points.emplace_back(p + R * q); };
  const MapVector3d size(m.geom_size + 3 * geom);
  const int type = m.geom_type[geom];
  if (type == mjGEOM_MESH) {
    const int mesh = m.geom_dataid[geom];
    for (int i = 0; i < m.mesh_vertnum[mesh]; ++i) {
      const float* v = m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + i);
      hold({v[0], v[1], v[2]});
    }
    return points;
  }
  Eigen::Vector3d half = size;
  if (type == mjGEOM_SPHERE) half.setConstant(size.x());
  if (type == mjGEOM_CYLINDER) half << size.x(), size.x(), size.y();
  if (type == mjGEOM_CAPSULE) half << size.x(), size.x(), size.x() + size.y();
  constexpr int kSides = 16;  // of the prism around what is round
  const bool box = type == mjGEOM_BOX;
  const int corners = box ? 4 : kSides;
  const double out = 1.0 / std::cos(std::numbers::pi / corners);
  for (int i = 0; i < corners; ++i) {
    const double angle = (2.0 * i + 1.0) * std::numbers::pi / corners;
    // A box's corners are where the circle of radius sqrt(2) has them.
    const double x = out * std::cos(angle) * half.x(), y = out * std::sin(angle) * half.y();
    for (const double z : {-half.z(), half.z()}) hold({x, y, z});
  }
  return points;
}

std::vector<std::vector<Eigen::Vector3d>> VehicleOutlines(const std::string& path) {
  const MujocoModel model = CompileMjcfFile(path);
  const mjModel& m = *model;
  const MujocoData data = MakeMujocoData(m);
  CallMujoco([&] {
    mj_kinematics(&m, data.get());
    mj_comPos(&m, data.get());
  });
  std::vector<std::vector<Eigen::Vector3d>> outlines;
  int base = 0;
  for (int joint = 0; joint < m.njnt && base == 0; ++joint) {
    if (m.jnt_type[joint] == mjJNT_FREE) base = m.jnt_bodyid[joint];
  }
  if (base == 0) return outlines;
  const MapVector3d p_WB(data->subtree_com + 3 * base);
  const Eigen::Map<const RowMajor3d> R_WB(data->xmat + 9 * base);
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int body = m.geom_bodyid[geom];
    if (body == 0 || m.body_rootid[body] != m.body_rootid[base]) continue;
    outlines.push_back(PointsAround(m, *data, geom));
    for (Eigen::Vector3d& p : outlines.back()) p = R_WB.transpose() * (p - p_WB);
  }
  return outlines;
}

}  // namespace touchdown::sim
