// SPDX-License-Identifier: BSD-3-Clause
// Reads a vehicle's parameters from the compiled model, not from the text. So they are those that
// the physics uses, whatever units, defaults or elements the file has.

#include "sim/vehicle/vehicle_file.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"
#include "sim/base/input_file.h"
#include "sim/mujoco/mjcf_source.h"
#include "sim/mujoco/mujoco_model.h"

namespace touchdown::sim {
namespace {

using estimation::VehicleModel;

constexpr double kTolerance = 1.0e-6;
constexpr double kUnevenFeet = 1.0e-4;        // [m]
constexpr double kLeastThrustToWeight = 1.2;  // below, there is nothing left to steer with
constexpr double kLeastTurn = 10.0;           // of roll and pitch [rad/s^2] ...
constexpr double kLeastYawTurn = 0.5;         // ... and of the heading
// With the default limits one in three landings beside obstacles fails at 17 rad/s^2, and none at 35. With an
// acceleration of 2 m/s^2 none fails at 17 either (docs/results/flight_software/tables.md).
constexpr double kEasyTurn = 25.0;

std::string_view GeomName(const mjModel& m, int geom) { return m.names + m.name_geomadr[geom]; }

bool IsUpright(const mjtNum* quat) { return std::abs(std::abs(quat[0]) - 1.0) < kTolerance; }

Eigen::Vector3d Three(const mjtNum* p) { return {p[0], p[1], p[2]}; }

class Reader {
 public:
  Reader(const mjModel& m, VehicleFindings* findings) : m_(m), findings_(*findings) {}

  std::optional<VehicleModel> Read() {
    const std::size_t before = findings_.faults().size();
    body_ = Find(mjOBJ_BODY, "body", "vehicle");
    if (body_ < 0) return std::nullopt;
    ReadBody();
    ReadHull();
    ReadFeet();
    ReadDrag();
    if (m_.nu < estimation::kLeastActuators || m_.nu > estimation::kMostActuators) {
      Fault("it has " + std::to_string(m_.nu) + " actuators", "allowed are 4 to 8");
    } else {
      for (int i = 0; i < m_.nu; ++i) ReadRotor(i);
    }
    if (findings_.faults().size() == before) CheckFlight();
    if (findings_.faults().size() != before) return std::nullopt;
    return model_;
  }

 private:
  void Fault(std::string what, std::string remedy) {
    findings_.Fault(std::move(what), std::move(remedy));
  }

  int Find(int type, const std::string& kind, const std::string& name) {
    const int id = mj_name2id(&m_, type, name.c_str());
    if (id < 0)
      Fault("there is no " + kind + " named \"" + name + "\"",
            "docs/vehicles.md lists what there must be");
    return id;
  }

  void ReadBody() {
    const int joint = m_.body_jntadr[body_];
    if (m_.body_jntnum[body_] != 1 || m_.jnt_type[joint] != mjJNT_FREE || m_.nbody != 2) {
      Fault("body \"vehicle\" is not the only body with one joint, a free joint",
            "put all geoms and sites into it");
    }
    if (mju_norm3(m_.body_ipos + 3 * body_) > kTolerance) {
      Fault("the <inertial> of body \"vehicle\" is not at its origin",
            "move geoms and sites so that the centre of mass is");
    }
    model_.mass_kg = m_.body_mass[body_];
    model_.inertia = Three(m_.body_inertia + 3 * body_);
    const mjtNum* q = m_.body_iquat + 4 * body_;
    if (!IsUpright(q)) {
      model_.R_BI = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    }
  }

  void ReadHull() {
    const int hull = Find(mjOBJ_GEOM, "geom", "hull");
    if (hull < 0) return;
    const mjtNum* pos = m_.geom_pos + 3 * hull;
    if (m_.geom_type[hull] != mjGEOM_CYLINDER || std::hypot(pos[0], pos[1]) > kTolerance ||
        !IsUpright(m_.geom_quat + 4 * hull)) {
      Fault("geom \"hull\" is not a cylinder about z_B",
            "make it one that holds all of the vehicle");
    }
    model_.hull_radius = m_.geom_size[3 * hull];
    model_.hull_top = pos[2] + m_.geom_size[3 * hull + 1];
    model_.hull_bottom = m_.geom_size[3 * hull + 1] - pos[2];
  }

  void ReadFeet() {
    int feet = 0;
    double shortest = std::numeric_limits<double>::infinity();
    model_.foot_depth = 0.0;
    model_.foot_radius = 0.0;
    model_.foot_reach = 0.0;
    for (int geom = 0; geom < m_.ngeom; ++geom) {
      if (!GeomName(m_, geom).starts_with("foot")) continue;
      const mjtNum* p = m_.geom_pos + 3 * geom;
      const double radius = m_.geom_size[3 * geom];
      if (m_.geom_type[geom] != mjGEOM_SPHERE ||
          std::hypot(p[0], p[1]) + radius > model_.hull_radius) {
        Fault("geom \"" + std::string(GeomName(m_, geom)) +
                  "\" is not a sphere within the hull's radius",
              "make it one");
      }
      model_.foot_depth = std::max(model_.foot_depth, radius - p[2]);
      shortest = std::min(shortest, radius - p[2]);
      model_.foot_radius = std::max(model_.foot_radius, std::hypot(p[0], p[1]));
      model_.foot_reach = std::max(model_.foot_reach, mju_norm3(p) + radius);
      model_.foot_azimuths.push_back(std::atan2(p[1], p[0]));
      ++feet;
    }
    if (feet < 3) {
      Fault("it has " + std::to_string(feet) + " geoms named foot...", "allowed are 3 and more");
      return;
    }
    if (model_.foot_depth - shortest > kUnevenFeet) {
      Fault("the feet reach down " + Figure(shortest) + " to " + Figure(model_.foot_depth) + " m",
            "they must reach down equally far");
    }
    if (model_.foot_depth <= model_.hull_bottom) {
      Fault("the feet do not reach below geom \"hull\"",
            "lower them, or raise the hull's lower face");
    }
  }

  // Gear 0 0 1 and a reaction torque is a rotor; without the 1 it is a moment alone.
  void ReadRotor(int index) {
    const std::string name = "rotor" + std::to_string(index);
    const int site = Find(mjOBJ_SITE, "site", name);
    const int actuator = Find(mjOBJ_ACTUATOR, "actuator", name);
    if (site < 0 || actuator < 0) return;
    const mjtNum* gear = m_.actuator_gear + 6 * actuator;
    if (m_.actuator_trntype[actuator] != mjTRN_SITE || m_.actuator_trnid[2 * actuator] != site ||
        m_.site_bodyid[site] != body_ || !IsUpright(m_.site_quat + 4 * site) || gear[0] != 0.0 ||
        gear[1] != 0.0 || (gear[2] != 1.0 && gear[2] != 0.0)) {
      Fault("actuator \"" + name + "\" does not act on site \"" + name +
                "\" of body \"vehicle\", upright, with gear 0 0 1 0 0 k",
            "make it do so; a moment alone has gear 0 0 0 x y z");
    }
    if (m_.actuator_dyntype[actuator] != mjDYN_FILTER ||
        m_.actuator_gaintype[actuator] != mjGAIN_FIXED ||
        m_.actuator_gainprm[mjNGAIN * actuator] != 1.0 ||
        m_.actuator_biastype[actuator] != mjBIAS_NONE || m_.actuator_ctrllimited[actuator] == 0) {
      Fault("actuator \"" + name + "\" is not a <general> of this form",
            "dyntype filter, gainprm 1, no bias and a limited control range");
    }
    const double lag = m_.actuator_dynprm[mjNDYN * actuator];
    if (!(lag >= 0.005 && lag <= 1.0)) {
      Fault("lag of " + name + " is " + Figure(lag) + " s", "allowed is 0.005 to 1 s");
    }
    if (index == 0) model_.rotor_lag_s = lag;
    if (lag != model_.rotor_lag_s) {
      Fault("lag of " + name + " differs from that of rotor0", "give all the same");
    }
    estimation::Actuator rotor;
    rotor.p_BR = Three(m_.site_pos + 3 * site);
    rotor.thrust = gear[2];
    rotor.moment_B = Three(gear + 3);
    rotor.min = m_.actuator_ctrlrange[2 * actuator];
    rotor.max = m_.actuator_ctrlrange[2 * actuator + 1];
    if (rotor.thrust > 0.0 && rotor.min < 0.0) {
      Fault("lower end of the control range of " + name + " is " + Figure(rotor.min),
            "allowed is 0 and more");
    }
    model_.actuators.push_back(rotor);
    if (rotor.thrust == 0.0) return;
    const bool first = ++rotors_ == 1;
    const double radius = m_.site_type[site] == mjGEOM_CYLINDER ? m_.site_size[3 * site] : 0.0;
    model_.rotor_radius = first ? radius : std::min(model_.rotor_radius, radius);
  }

  void ReadDrag() {
    const int linear = Find(mjOBJ_NUMERIC, "numeric", "rotor_drag");
    const int area = Find(mjOBJ_NUMERIC, "numeric", "body_drag_area");
    if (linear < 0 || area < 0) return;
    if (m_.numeric_size[linear] != 3 || m_.numeric_size[area] != 1) {
      Fault("numeric \"rotor_drag\" has not three numbers or \"body_drag_area\" not one",
            "give three [N s/m] and one [m^2]");
      return;
    }
    model_.rotor_drag = Three(m_.numeric_data + m_.numeric_adr[linear]);
    model_.body_drag_area = m_.numeric_data[m_.numeric_adr[area]];
    const auto within = [&](const char* what, double value) {
      if (!(value >= 0.0 && value <= 10.0)) {
        Fault(what + (" is " + Figure(value)), "allowed is 0 to 10");
      }
    };
    within("smallest of rotor_drag", model_.rotor_drag.minCoeff());
    within("largest of rotor_drag", model_.rotor_drag.maxCoeff());
    within("body_drag_area", model_.body_drag_area);
  }

  void CheckFlight() {
    try {
      const double most = estimation::AllocationOf(model_).thrust_max;
      if (most < kLeastThrustToWeight * model_.HoverThrust()) {
        Fault("the rotors' largest thrust, " + Figure(most) +
                  " N, does not carry its weight 1.2 times, " +
                  Figure(kLeastThrustToWeight * model_.HoverThrust()) + " N",
              "look at mass and thrust ranges");
        return;
      }
      const Eigen::Vector3d turn = estimation::HoverTurn(model_);
      const std::string turns = "from hover it can be turned about x, y and z with " +
                                Figure(turn.x()) + ", " + Figure(turn.y()) + " and " +
                                Figure(turn.z()) + " rad/s^2";
      const double tilt = turn.head<2>().minCoeff();
      if (!TurnsEnough(model_)) {
        Fault(turns,
              "allowed are 10, 10 and 0.5 and more: look at inertia, arms, thrust ranges and "
              "senses of rotation, or give "
              "airframe.moment_max where the file has moments for actuators");
      } else if (tilt < kEasyTurn) {
        findings_.Warn(turns, "fly it with limits.acceleration: 2 beside obstacles");
      }
    } catch (const std::invalid_argument& error) {
      const std::string_view why = error.what();
      Fault("its rotors cannot make thrust and three moments, " +
                std::string(why.substr(why.find(": ") + 2)),
            "look at their places about the centre of mass and at their senses of rotation; "
            "airframe.rotor_senses: auto turns neighbours against each other");
    }
  }

  const mjModel& m_;
  VehicleFindings& findings_;
  int body_ = -1;
  int rotors_ = 0;  // read so far
  VehicleModel model_;
};

}  // namespace

bool TurnsEnough(const estimation::VehicleModel& model) {
  const Eigen::Vector3d turn = estimation::HoverTurn(model);
  return turn.head<2>().minCoeff() >= kLeastTurn && turn.z() >= kLeastYawTurn;
}

std::string ReadVehicleFile(const std::string& path) {
  std::string text = ReadInputFile(path, kMostMjcfBytes);
  if (text.empty()) RefuseFile(path, "it is empty");
  return text;
}

std::optional<estimation::VehicleModel> ReadVehicleModel(const std::string& mjcf,
                                                         VehicleFindings* findings) {
  const MujocoModel compiled = CompileVehicleMjcf(mjcf);
  return Reader(*compiled, findings).Read();
}

estimation::VehicleModel LoadVehicleModel(const std::string& mjcf) {
  VehicleFindings findings;
  const std::optional<estimation::VehicleModel> model = ReadVehicleModel(mjcf, &findings);
  findings.ThrowFaults();
  return *model;
}

}  // namespace touchdown::sim
