// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/vehicle_looks.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mjcf_text.h"
#include "sim/mujoco/mujoco_model.h"

namespace touchdown::sim {
namespace {

constexpr char kRotor[] = "rotor";
constexpr char kDiscColor[] = "0.75 0.86 0.97 0.38";
constexpr char kFrameColor[] = "0.16 0.17 0.20 1";
constexpr double kDiscHeight = 0.004;  // half of it [m]
constexpr double kDiscShare = 0.48;    // of the distance to the next rotor
constexpr double kArmShare = 0.06;     // radius of an arm, of its length

template <typename Number>
std::string Numbers(const Number* first, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += estimation::NumberText(first[i]) + ' ';
  return text;
}

// MJCF's words for the shapes that need no asset; nullptr: another one.
const char* ShapeOf(int type) {
  switch (type) {
    case mjGEOM_SPHERE:
      return "sphere";
    case mjGEOM_CAPSULE:
      return "capsule";
    case mjGEOM_ELLIPSOID:
      return "ellipsoid";
    case mjGEOM_CYLINDER:
      return "cylinder";
    case mjGEOM_BOX:
      return "box";
    default:
      return nullptr;
  }
}

void WriteShape(int type, const mjtNum* size, const mjtNum* pos, const mjtNum* quat,
                const std::string& rgba, std::ostream& xml) {
  xml << "<geom type='" << ShapeOf(type) << "' size='" << Numbers(size, 3) << "' pos='"
      << Numbers(pos, 3) << "' quat='" << Numbers(quat, 4) << "' rgba='" << rgba << "'/>\n";
}

// What the compiled model has for the eye at its body; whether that is more than its feet.
bool WriteGeoms(const mjModel& m, int body, std::ostream& xml) {
  bool more = false;
  for (int i = 0; i < m.ngeom; ++i) {
    if (m.geom_bodyid[i] != body || m.geom_group[i] > 2 || ShapeOf(m.geom_type[i]) == nullptr) {
      continue;
    }
    more = more || m.geom_contype[i] == 0;
    WriteShape(m.geom_type[i], m.geom_size + 3 * i, m.geom_pos + 3 * i, m.geom_quat + 4 * i,
               Numbers(m.geom_rgba + 4 * i, 4), xml);
  }
  return more;
}

// From B's origin.
void WriteArm(const mjtNum* end, std::ostream& xml) {
  const double length = Eigen::Map<const Eigen::Vector3d>(end).norm();
  if (!(length > 0.0)) return;
  xml << "<geom type='capsule' size='" << estimation::NumberText(kArmShare * length)
      << "' fromto='0 0 0 " << Numbers(end, 3) << "' rgba='" << kFrameColor << "'/>\n";
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
  const MujocoModel model = CompileMjcf(vehicle_mjcf);
  const mjModel& m = *model;
  const int body = mj_name2id(&m, mjOBJ_BODY, "vehicle");
  if (body < 0) throw std::invalid_argument("the vehicle's MJCF has no body named vehicle");
  std::ostringstream xml;
  const bool has_frame = WriteGeoms(m, body, xml);
  const std::vector<int> sites = RotorSites(m, body);
  for (const int i : sites) {
    const mjtNum* const pos = m.site_pos + 3 * i;
    const bool has_disc = m.site_type[i] == mjGEOM_CYLINDER;
    const double next = DistanceToNext(m, sites, i);
    if (has_disc || next < std::numeric_limits<double>::infinity()) {
      const mjtNum size[3] = {has_disc ? m.site_size[3 * i] : kDiscShare * next, kDiscHeight, 0.0};
      WriteShape(mjGEOM_CYLINDER, size, pos, m.site_quat + 4 * i, kDiscColor, xml);
    }
    if (!has_frame) WriteArm(pos, xml);
  }
  for (int i = 0; !has_frame && i < m.ngeom; ++i) {
    if (m.geom_bodyid[i] == body && m.geom_type[i] == mjGEOM_SPHERE) {
      WriteArm(m.geom_pos + 3 * i, xml);  // a foot
    }
  }
  return xml.str();
}

}  // namespace touchdown::sim
