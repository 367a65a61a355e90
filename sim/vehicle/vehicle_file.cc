// SPDX-License-Identifier: BSD-3-Clause
// Reads a vehicle's parameters from the compiled model, not from the text, so that they are those
// the physics uses whatever units, defaults or elements the file was written with.

#include "sim/vehicle/vehicle_file.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <Eigen/LU>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mujoco_model.h"

namespace touchdown::sim {
namespace {

using estimation::VehicleModel;

constexpr double kTolerance = 1.0e-6;
constexpr double kUnevenFeet = 1.0e-4;  // [m]

int Find(const mjModel& m, int type, const std::string& kind, const std::string& name) {
  const int id = mj_name2id(&m, type, name.c_str());
  if (id < 0) RefuseVehicle("there is no " + kind + " named \"" + name + "\"");
  return id;
}

std::string_view GeomName(const mjModel& m, int geom) { return m.names + m.name_geomadr[geom]; }

bool IsUpright(const mjtNum* quat) { return std::abs(std::abs(quat[0]) - 1.0) < kTolerance; }

void ReadBody(const mjModel& m, int body, VehicleModel* model) {
  const int joint = m.body_jntadr[body];
  if (m.body_jntnum[body] != 1 || m.jnt_type[joint] != mjJNT_FREE || m.nbody != 2) {
    RefuseVehicle("body \"vehicle\" must be the only body and have one joint, a free joint");
  }
  if (mju_norm3(m.body_ipos + 3 * body) > kTolerance || !IsUpright(m.body_iquat + 4 * body)) {
    RefuseVehicle(
        "the <inertial> of body \"vehicle\" must be at its origin, principal axes along its own");
  }
  model->mass_kg = m.body_mass[body];
  model->inertia = Eigen::Map<const Eigen::Vector3d>(m.body_inertia + 3 * body);
}

void ReadHull(const mjModel& m, VehicleModel* model) {
  const int hull = Find(m, mjOBJ_GEOM, "geom", "hull");
  const mjtNum* pos = m.geom_pos + 3 * hull;
  if (m.geom_type[hull] != mjGEOM_CYLINDER || std::hypot(pos[0], pos[1]) > kTolerance ||
      !IsUpright(m.geom_quat + 4 * hull)) {
    RefuseVehicle("geom \"hull\" must be a cylinder about z_B");
  }
  model->hull_radius = m.geom_size[3 * hull];
  model->hull_top = pos[2] + m.geom_size[3 * hull + 1];
  model->hull_bottom = m.geom_size[3 * hull + 1] - pos[2];

  int feet = 0;
  double shortest = std::numeric_limits<double>::infinity();
  model->foot_depth = 0.0;
  model->foot_radius = 0.0;
  model->foot_reach = 0.0;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    if (!GeomName(m, geom).starts_with("foot")) continue;
    const mjtNum* p = m.geom_pos + 3 * geom;
    const double radius = m.geom_size[3 * geom];
    if (m.geom_type[geom] != mjGEOM_SPHERE ||
        std::hypot(p[0], p[1]) + radius > model->hull_radius) {
      RefuseVehicle("geom \"" + std::string(GeomName(m, geom)) +
                    "\" must be a sphere within the hull's radius");
    }
    model->foot_depth = std::max(model->foot_depth, radius - p[2]);
    shortest = std::min(shortest, radius - p[2]);
    model->foot_radius = std::max(model->foot_radius, std::hypot(p[0], p[1]));
    model->foot_reach = std::max(model->foot_reach, mju_norm3(p) + radius);
    model->foot_azimuths.push_back(std::atan2(p[1], p[0]));
    ++feet;
  }
  if (feet < 3)
    RefuseVehicle("it has " + std::to_string(feet) + " geoms named foot...; allowed is >= 3");
  if (model->foot_depth - shortest > kUnevenFeet) {
    RefuseVehicle("the feet must reach down equally far, not " + std::to_string(shortest) + " to " +
                  std::to_string(model->foot_depth) + " m");
  }
  if (model->foot_depth <= model->hull_bottom)
    RefuseVehicle("the feet must reach below geom \"hull\"");
}

void ReadRotor(const mjModel& m, int body, int index, VehicleModel* model) {
  const std::string name = "rotor" + std::to_string(index);
  const int site = Find(m, mjOBJ_SITE, "site", name);
  const int actuator = Find(m, mjOBJ_ACTUATOR, "actuator", name);
  const mjtNum* gear = m.actuator_gear + 6 * actuator;
  const bool along_z = gear[0] == 0.0 && gear[1] == 0.0 && gear[2] == 1.0 && gear[3] == 0.0 &&
                       gear[4] == 0.0 && gear[5] != 0.0;
  if (m.actuator_trntype[actuator] != mjTRN_SITE || m.actuator_trnid[2 * actuator] != site ||
      m.site_bodyid[site] != body || !IsUpright(m.site_quat + 4 * site) || !along_z) {
    RefuseVehicle("actuator \"" + name + "\" must act on site \"" + name +
                  "\" of body \"vehicle\", upright, with gear 0 0 1 0 0 k, k not 0");
  }
  if (m.actuator_dyntype[actuator] != mjDYN_FILTER ||
      m.actuator_gaintype[actuator] != mjGAIN_FIXED ||
      m.actuator_gainprm[mjNGAIN * actuator] != 1.0 ||
      m.actuator_biastype[actuator] != mjBIAS_NONE || m.actuator_ctrllimited[actuator] == 0) {
    RefuseVehicle("actuator \"" + name +
                  "\" must have dyntype filter, gainprm 1, no bias and a limited control range");
  }
  const double lag = m.actuator_dynprm[mjNDYN * actuator];
  const double low = m.actuator_ctrlrange[2 * actuator];
  const double high = m.actuator_ctrlrange[2 * actuator + 1];
  estimation::CheckWithin("vehicle file: lag of " + name, lag, 0.005, 1.0);
  estimation::CheckWithin("vehicle file: lower end of the control range of " + name, low, 0.0,
                          high);
  const double torque = std::abs(gear[5]);
  if (index == 0) {
    model->rotor_lag_s = lag;
    model->rotor_thrust_min = low;
    model->rotor_thrust_max = high;
    model->torque_per_thrust = torque;
  } else if (lag != model->rotor_lag_s || low != model->rotor_thrust_min ||
             high != model->rotor_thrust_max || torque != model->torque_per_thrust) {
    RefuseVehicle("actuator \"" + name +
                  "\" differs from \"rotor0\" in lag, range or torque per thrust");
  }
  estimation::Rotor& rotor = model->rotors[static_cast<std::size_t>(index)];
  rotor.p_BR = Eigen::Map<const Eigen::Vector3d>(m.site_pos + 3 * site);
  const double radius = m.site_type[site] == mjGEOM_CYLINDER ? m.site_size[3 * site] : 0.0;
  model->rotor_radius = index == 0 ? radius : std::min(model->rotor_radius, radius);
  rotor.spin = gear[5] > 0.0 ? 1.0 : -1.0;
}

void ReadDrag(const mjModel& m, VehicleModel* model) {
  const int linear = Find(m, mjOBJ_NUMERIC, "numeric", "rotor_drag");
  const int area = Find(m, mjOBJ_NUMERIC, "numeric", "body_drag_area");
  if (m.numeric_size[linear] != 3 || m.numeric_size[area] != 1) {
    RefuseVehicle("numeric \"rotor_drag\" must have three numbers and \"body_drag_area\" one");
  }
  model->rotor_drag = Eigen::Map<const Eigen::Vector3d>(m.numeric_data + m.numeric_adr[linear]);
  model->body_drag_area = m.numeric_data[m.numeric_adr[area]];
  estimation::CheckWithin("vehicle file: smallest of rotor_drag", model->rotor_drag.minCoeff(), 0.0,
                          10.0);
  estimation::CheckWithin("vehicle file: largest of rotor_drag", model->rotor_drag.maxCoeff(), 0.0,
                          10.0);
  estimation::CheckWithin("vehicle file: body_drag_area", model->body_drag_area, 0.0, 10.0);
}

// The rotors' wrench is linear in their thrusts; z_B's column is thrust, then the three moments.
void CheckSteerable(const VehicleModel& model) {
  Eigen::Matrix4d wrench;
  for (int i = 0; i < 4; ++i) {
    const estimation::Rotor& rotor = model.rotors[static_cast<std::size_t>(i)];
    wrench.col(i) << 1.0, rotor.p_BR.y(), -rotor.p_BR.x(), rotor.spin * model.torque_per_thrust;
  }
  const Eigen::FullPivLU<Eigen::Matrix4d> lu(wrench);
  if (!lu.isInvertible() || lu.inverse().col(0).minCoeff() <= 0.0) {
    RefuseVehicle(
        "its rotors cannot make thrust and three moments: their places and senses of rotation");
  }
}

}  // namespace

void RefuseVehicle(const std::string& what) {
  throw std::invalid_argument("vehicle file: " + what);
}

std::string ReadVehicleFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file.is_open() || file.bad() || text.empty()) {
    throw std::invalid_argument("vehicle file " + path + " cannot be read or is empty");
  }
  return text;
}

estimation::VehicleModel LoadVehicleModel(const std::string& mjcf) {
  const MujocoModel compiled = CompileMjcf(mjcf);
  const mjModel& m = *compiled;
  const int body = Find(m, mjOBJ_BODY, "body", "vehicle");
  VehicleModel model;
  ReadBody(m, body, &model);
  ReadHull(m, &model);
  if (m.nu != 4) RefuseVehicle("it has " + std::to_string(m.nu) + " actuators; allowed is 4");
  for (int i = 0; i < 4; ++i) ReadRotor(m, body, i, &model);
  ReadDrag(m, &model);
  CheckSteerable(model);
  constexpr double kLeastThrustToWeight = 1.2;  // below, there is nothing left to steer with
  if (model.MaxThrust() < kLeastThrustToWeight * model.HoverThrust()) {
    RefuseVehicle("the rotors' largest thrust, " + estimation::NumberText(model.MaxThrust()) +
                  " N, does not carry its weight 1.2 times, " +
                  estimation::NumberText(kLeastThrustToWeight * model.HoverThrust()) + " N");
  }
  return model;
}

}  // namespace touchdown::sim
