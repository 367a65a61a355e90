// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/vehicle_looks.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mjcf_text.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/vehicle/vehicle_shapes.h"

namespace touchdown::sim {
namespace {

constexpr char kRotor[] = "rotor";
constexpr char kDiscColor[] = "0.75 0.86 0.97 0.38";
constexpr double kDiscHeight = 0.004;  // half of it [m]
constexpr double kDiscShare = 0.48;    // of the distance to the next rotor

template <typename Number>
std::string Numbers(const Number* first, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += estimation::NumberText(first[i]) + ' ';
  return text;
}

void WriteShape(const char* kind, const Eigen::Vector3d& size, const Eigen::Vector3d& p_BG,
                const Eigen::Quaterniond& q_BG, const std::string& rgba, std::ostream& xml) {
  const double quat[4] = {q_BG.w(), q_BG.x(), q_BG.y(), q_BG.z()};
  xml << "<geom type='" << kind << "' size='" << Numbers(size.data(), 3) << "' pos='"
      << Numbers(p_BG.data(), 3) << "' quat='" << Numbers(quat, 4) << "' rgba='" << rgba << "'/>\n";
}

std::vector<int> RotorSites(const mjModel& m, int body) {
  std::vector<int> sites;
  for (int i = 0; i < m.nsite; ++i) {
    const std::string name = m.names + m.name_siteadr[i];
    if (m.site_bodyid[i] == body && name.starts_with(kRotor)) sites.push_back(i);
  }
  return sites;
}

double DistanceToNext(const mjModel& m, const std::vector<int>& sites, int site) {
  double least = std::numeric_limits<double>::infinity();
  const auto at = [&](int i) { return Eigen::Map<const Eigen::Vector3d>(m.site_pos + 3 * i); };
  for (const int other : sites) {
    const double distance = (at(other) - at(site)).norm();
    if (distance > 0.0) least = std::min(least, distance);
  }
  return least;
}

}  // namespace

std::string VehicleLooks(const std::string& vehicle_mjcf) {
  std::ostringstream xml;
  for (const VehicleShape& shape : VehicleShapes(vehicle_mjcf)) {
    if (shape.kind == VehicleShape::Kind::kMesh) continue;  // it would need an asset
    WriteShape(ToString(shape.kind), shape.size, shape.p_BG, shape.q_BG,
               Numbers(shape.rgba.data(), 4), xml);
  }
  const MujocoModel model = CompileMjcf(vehicle_mjcf);
  const mjModel& m = *model;
  const std::vector<int> sites = RotorSites(m, mj_name2id(&m, mjOBJ_BODY, "vehicle"));
  for (const int i : sites) {
    const bool has_disc = m.site_type[i] == mjGEOM_CYLINDER;
    const double next = DistanceToNext(m, sites, i);
    if (!has_disc && next == std::numeric_limits<double>::infinity()) continue;
    const mjtNum* const q = m.site_quat + 4 * i;
    WriteShape("cylinder", {has_disc ? m.site_size[3 * i] : kDiscShare * next, kDiscHeight, 0.0},
               Eigen::Map<const Eigen::Vector3d>(m.site_pos + 3 * i), {q[0], q[1], q[2], q[3]},
               kDiscColor, xml);
  }
  return xml.str();
}

}  // namespace touchdown::sim
