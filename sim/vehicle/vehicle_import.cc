// SPDX-License-Identifier: BSD-3-Clause
// The file is compiled and placed at its reference pose; everything is read from there in the frame of
// the body with the free joint. The rigid bodies below it are put together by the parallel axis theorem.
// What is written is the vehicle alone, so that nothing else of the file (other bodies, options,
// contacts, meshes) can touch the simulation.

#include "sim/vehicle/vehicle_import.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mjcf_text.h"
#include "sim/mujoco/mujoco_call.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::sim {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kUpright = 0.9998;        // cosine of one degree
constexpr double kSame = 1e-6;             // relative, of figures that must agree
constexpr double kSkewInertia = 0.05;      // products over the least moment
constexpr double kFeetShare = 0.6;         // of the hull's radius
constexpr double kFeetClearance = 0.35;    // hull above soles, over the feet's distance from z_B
constexpr double kLeastHullHeight = 0.01;  // [m]

Eigen::Vector3d Vec3(const mjtNum* p) { return {p[0], p[1], p[2]}; }

std::string Quoted(const mjModel& m, int address, const char* kind, int index) {
  const std::string name = m.names + address;
  const std::string word = kind;
  return name.empty() ? word + " " + std::to_string(index) : word + " \"" + name + "\"";
}

struct Motor {
  Eigen::Vector3d p_BR = Eigen::Vector3d::Zero();
  double low = 0.0, high = 0.0;  // thrust [N]
  double torque = 0.0;           // about z_B per newton [m]
  double lag = 0.0;              // [s]
};

struct Outline {
  double radius = 0.0, bottom = 0.0, top = 0.0;
  void Hold(const Eigen::Vector3d& p) {
    radius = std::max(radius, std::hypot(p.x(), p.y()));
    bottom = std::min(bottom, p.z());
    top = std::max(top, p.z());
  }
};

class Import {
 public:
  Import(const mjModel& m, const AirframeExtras& extras)
      : m_(m), data_(MakeMujocoData(m)), d_(*data_), extras_(extras) {
    CallMujoco([&] { mj_kinematics(&m_, data_.get()); });
    FindBase();
    ReadMass();
    if (m_.nu != 4)
      RefuseVehicle("it has " + std::to_string(m_.nu) + " actuators; allowed is 4, one a rotor");
    for (int i = 0; i < 4; ++i) motors_.push_back(ReadMotor(i));
    CheckMotorsAgree();
    ReadOutline();
  }

  std::string Text() const;

 private:
  void FindBase() {
    int free_joints = 0;
    for (int j = 0; j < m_.njnt; ++j) {
      if (m_.jnt_type[j] != mjJNT_FREE) {
        RefuseVehicle(Quoted(m_, m_.name_jntadr[j], "joint", j) +
                      " moves; allowed is one free joint alone");
      }
      const int dof = m_.jnt_dofadr[j];
      CheckNothingHolds(Quoted(m_, m_.name_jntadr[j], "joint", j), m_.jnt_stiffness[j], dof);
      base_ = m_.jnt_bodyid[j];
      ++free_joints;
    }
    if (free_joints != 1) {
      RefuseVehicle("it has " + std::to_string(free_joints) + " free joints; allowed is 1");
    }
    R_WB_ = Eigen::Map<const Matrix>(d_.xmat + 9 * base_);
  }

  // What the free joint adds to inertia and drag would be lost.
  void CheckNothingHolds(const std::string& joint, double stiffness, int dof) const {
    for (int i = dof; i < dof + 6; ++i) {
      const char* has = m_.dof_damping[i] != 0.0        ? "damping"
                        : m_.dof_armature[i] != 0.0     ? "armature"
                        : m_.dof_frictionloss[i] != 0.0 ? "frictionloss"
                        : stiffness != 0.0              ? "stiffness"
                                                        : nullptr;
      if (has != nullptr) {
        RefuseVehicle(joint + " has " + has +
                      "; allowed is 0: drag is a matter of airframe.rotor_drag");
      }
    }
  }

  bool OfVehicle(int body) const {
    return body != 0 && m_.body_rootid[body] == m_.body_rootid[base_];
  }

  void ReadMass() {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int body = 1; body < m_.nbody; ++body) {
      if (!OfVehicle(body)) continue;
      mass_ += m_.body_mass[body];
      moment += m_.body_mass[body] * Vec3(d_.xipos + 3 * body);
    }
    if (!(mass_ > 0.0)) RefuseVehicle("it has no mass");
    p_WB_ = moment / mass_;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (int body = 1; body < m_.nbody; ++body) {
      if (!OfVehicle(body)) continue;
      const Matrix R = Eigen::Map<const Matrix>(d_.ximat + 9 * body);
      const Eigen::Vector3d arm = Vec3(d_.xipos + 3 * body) - p_WB_;
      inertia += R * Vec3(m_.body_inertia + 3 * body).asDiagonal() * R.transpose();
      inertia += m_.body_mass[body] *
                 (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
    }
    inertia = (R_WB_.transpose() * inertia * R_WB_).eval();
    inertia_ = inertia.diagonal();
    inertia.diagonal().setZero();
    const double skew = inertia.cwiseAbs().maxCoeff() / inertia_.minCoeff();
    if (skew > kSkewInertia) {
      RefuseVehicle(
          "its largest product of inertia is " + estimation::NumberText(skew) +
          " of its least moment about the centre of mass; allowed is 0.05: its axes must be those "
          "of its inertia");
    }
  }

  // Of the actuator before its gear, as MuJoCo clamps it: control, activation, gain, force.
  std::array<double, 2> ForceRange(int i) const {
    std::array<double, 2> range = {m_.actuator_ctrlrange[2 * i], m_.actuator_ctrlrange[2 * i + 1]};
    const auto clamp = [&](const mjtNum* limits) {
      for (double& end : range) end = std::clamp(end, limits[0], limits[1]);
    };
    if (m_.actuator_actlimited[i] != 0) clamp(m_.actuator_actrange + 2 * i);
    for (double& end : range) end *= m_.actuator_gainprm[mjNGAIN * i];
    if (m_.actuator_forcelimited[i] != 0) clamp(m_.actuator_forcerange + 2 * i);
    return range;
  }

  Motor ReadMotor(int i) const {
    const std::string name = Quoted(m_, m_.name_actuatoradr[i], "actuator", i);
    const int site = m_.actuator_trnid[2 * i];
    if (m_.actuator_trntype[i] != mjTRN_SITE || !OfVehicle(m_.site_bodyid[site])) {
      RefuseVehicle(
          name + " does not act on a site of the vehicle; allowed are four thrust motors at sites");
    }
    const mjtNum* gear = m_.actuator_gear + 6 * i;
    if (gear[0] != 0.0 || gear[1] != 0.0 || gear[3] != 0.0 || gear[4] != 0.0 || gear[2] == 0.0) {
      RefuseVehicle(name + " must have gear \"0 0 f 0 0 k\", f not 0");
    }
    if (gear[5] == 0.0)
      RefuseVehicle(name + " has no reaction torque, the last number of its gear");
    if (m_.actuator_gaintype[i] != mjGAIN_FIXED || m_.actuator_biastype[i] != mjBIAS_NONE) {
      RefuseVehicle(name + " must have a fixed gain and no bias, as a motor has");
    }
    if (m_.actuator_trnid[2 * i + 1] >= 0) {
      RefuseVehicle(name + " has a refsite; allowed are motors that act on one site");
    }
    if (m_.actuator_ctrllimited[i] == 0) RefuseVehicle(name + " has no ctrlrange");
    const Matrix R_WS = Eigen::Map<const Matrix>(d_.site_xmat + 9 * site);
    const double upright = R_WS.col(2).dot(R_WB_.col(2));
    const double scale = gear[2] * upright;
    if (std::abs(upright) < kUpright) {
      RefuseVehicle(name + " does not push along the z axis of the body with the free joint");
    }
    Motor motor;
    motor.p_BR = ToB(Vec3(d_.site_xpos + 3 * site));
    const std::array<double, 2> force = ForceRange(i);
    motor.low = std::min(scale * force[0], scale * force[1]);
    motor.high = std::max(scale * force[0], scale * force[1]);
    if (!(motor.low >= 0.0 && motor.high > motor.low)) {
      RefuseVehicle(name + " pushes with " + estimation::NumberText(motor.low) + " to " +
                    estimation::NumberText(motor.high) + " N along z; allowed is a range above 0");
    }
    motor.torque = gear[5] / gear[2];
    if (m_.actuator_dyntype[i] == mjDYN_NONE) {
      motor.lag = extras_.rotor_lag;
    } else if (m_.actuator_dyntype[i] == mjDYN_FILTER) {
      motor.lag = m_.actuator_dynprm[mjNDYN * i];
    } else {
      RefuseVehicle(name + " must have dyntype none or filter");
    }
    return motor;
  }

  void CheckMotorsAgree() const {
    const auto same = [](double a, double b) { return std::abs(a - b) <= kSame * std::abs(b); };
    const Motor& first = motors_.front();
    for (std::size_t i = 1; i < motors_.size(); ++i) {
      const Motor& motor = motors_[i];
      if (!same(motor.low, first.low) || !same(motor.high, first.high) ||
          !same(motor.lag, first.lag) || !same(std::abs(motor.torque), std::abs(first.torque))) {
        RefuseVehicle(Quoted(m_, m_.name_actuatoradr[i], "actuator", static_cast<int>(i)) +
                      " differs from the first one in thrust, lag or torque per thrust");
      }
    }
  }

  // Points that hold the geom: its mesh's, else those of a prism around it.
  void HoldGeom(int geom, Outline* outline) const {
    const Eigen::Vector3d p = Vec3(d_.geom_xpos + 3 * geom);
    const Matrix R = Eigen::Map<const Matrix>(d_.geom_xmat + 9 * geom);
    const auto hold = [&](const Eigen::Vector3d& q) { outline->Hold(ToB(p + R * q)); };
    const Eigen::Vector3d size = Vec3(m_.geom_size + 3 * geom);
    const int type = m_.geom_type[geom];
    if (type == mjGEOM_MESH) {
      const int mesh = m_.geom_dataid[geom];
      for (int i = 0; i < m_.mesh_vertnum[mesh]; ++i) {
        const float* v = m_.mesh_vert + 3 * (m_.mesh_vertadr[mesh] + i);
        hold({v[0], v[1], v[2]});
      }
      return;
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
  }

  void ReadOutline() {
    for (int geom = 0; geom < m_.ngeom; ++geom) {
      if (OfVehicle(m_.geom_bodyid[geom])) HoldGeom(geom, &outline_);
    }
    for (const Motor& motor : motors_) outline_.Hold(motor.p_BR);
  }

  Eigen::Vector3d ToB(const Eigen::Vector3d& p_W) const {
    return R_WB_.transpose() * (p_W - p_WB_);
  }

  const mjModel& m_;
  MujocoData data_;
  const mjData& d_;
  AirframeExtras extras_;
  int base_ = -1;
  Eigen::Matrix3d R_WB_ = Eigen::Matrix3d::Identity();
  double mass_ = 0.0;
  Eigen::Vector3d p_WB_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d inertia_ = Eigen::Vector3d::Zero();
  std::vector<Motor> motors_;
  Outline outline_;
};

std::string Import::Text() const {
  const bool own_hull = !extras_.hull.isZero(), own_feet = !extras_.feet.isZero();
  const double radius = own_hull ? extras_.hull[0] : outline_.radius;
  const double at = own_feet ? extras_.feet[0] : kFeetShare * radius;
  const double bottom = own_hull ? extras_.hull[1] : outline_.bottom;
  const double depth = own_feet ? extras_.feet[1] : -bottom + kFeetClearance * at;
  const double top = own_hull ? extras_.hull[2] : std::max(outline_.top, bottom + kLeastHullHeight);
  estimation::CheckAbove("radius of the hull [m]", radius, 0.0, 5.0);
  estimation::CheckAbove("top of the hull above its bottom [m]", top - bottom, 0.0, 5.0);
  estimation::CheckWithin("radius of the feet [m]", at, 0.0, radius);
  estimation::CheckAbove("depth of the feet below the hull [m]", depth + bottom, 0.0, 5.0);
  const double ball = std::min({0.015, 0.1 * radius, 0.5 * (depth + bottom), radius - at});

  std::ostringstream xml;
  xml << "<mujoco model='imported quadrotor'>\n<custom>\n<numeric name='rotor_drag' data='"
      << VectorText({extras_.rotor_drag, extras_.rotor_drag, 0.0})
      << "'/>\n<numeric name='body_drag_area' data='"
      << estimation::NumberText(extras_.body_drag_area)
      << "'/>\n</custom>\n<worldbody>\n<body name='vehicle' pos='0 0 1'>\n"
      << "<freejoint name='vehicle'/>\n<inertial pos='0 0 0' mass='"
      << estimation::NumberText(mass_) << "' diaginertia='" << VectorText(inertia_) << "'/>\n"
      << "<geom name='hull' type='cylinder' size='" << estimation::NumberText(radius) << " "
      << estimation::NumberText(0.5 * (top - bottom)) << "' pos='0 0 "
      << estimation::NumberText(0.5 * (top + bottom))
      << "' condim='3' friction='0.6 0.005 0.0001' group='3' rgba='0.5 0.5 0.5 0.3'/>\n";
  for (int i = 0; i < 4; ++i) {
    const double angle = (0.25 + 0.5 * i) * std::numbers::pi;
    xml << "<geom name='foot" << i << "' type='sphere' size='" << estimation::NumberText(ball)
        << "' pos='" << VectorText({at * std::cos(angle), at * std::sin(angle), ball - depth})
        << "' condim='4' friction='1 0.005 0.0001' rgba='0.1 0.1 0.1 1'/>\n";
    xml << "<site name='rotor" << i << "' pos='" << VectorText(motors_[i].p_BR) << "'/>\n";
  }
  xml << "</body>\n</worldbody>\n<actuator>\n";
  for (int i = 0; i < 4; ++i) {
    const Motor& motor = motors_[i];
    xml << "<general name='rotor" << i << "' site='rotor" << i << "' gear='0 0 1 0 0 "
        << estimation::NumberText(std::copysign(motors_.front().torque, motor.torque))
        << "' ctrllimited='true' ctrlrange='" << estimation::NumberText(motors_.front().low) << " "
        << estimation::NumberText(motors_.front().high) << "' dyntype='filter' dynprm='"
        << estimation::NumberText(motors_.front().lag)
        << "' gaintype='fixed' gainprm='1' biastype='none'/>\n";
  }
  xml << "</actuator>\n</mujoco>\n";
  return xml.str();
}

bool OwnForm(const mjModel& m) {
  return mj_name2id(&m, mjOBJ_BODY, "vehicle") >= 0 && mj_name2id(&m, mjOBJ_GEOM, "hull") >= 0;
}

}  // namespace

bool IsInOwnForm(const std::string& path) {
  ReadVehicleFile(path);  // names a file that is not there
  return OwnForm(*CompileMjcfFile(path));
}

std::string ImportVehicle(const std::string& path, const AirframeExtras& extras) {
  std::string text = ReadVehicleFile(path);  // names a file that is not there
  const MujocoModel model = CompileMjcfFile(path);
  if (OwnForm(*model)) return text;
  estimation::CheckWithin("lag of the rotors [s]", extras.rotor_lag, 0.005, 1.0);
  return Import(*model, extras).Text();
}

}  // namespace touchdown::sim
