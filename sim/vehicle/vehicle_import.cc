// SPDX-License-Identifier: BSD-3-Clause
// The file is compiled and placed at its reference pose. Everything is read from there in the frame of the body with
// the free joint. The rigid bodies below it are combined by the parallel axis theorem. Only the vehicle is written. So
// nothing else of the file (other bodies, options, contacts, meshes) can affect the simulation.

#include "sim/vehicle/vehicle_import.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <Eigen/Eigenvalues>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mjcf_text.h"
#include "sim/mujoco/mujoco_call.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/vehicle/vehicle_outline.h"

namespace touchdown::sim {
namespace {

using estimation::NumberText;
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kUpright = 0.9998;                  // cosine of one degree
constexpr double kSame = 1e-6;                       // relative, of figures that must agree
constexpr double kNoProduct = 1e-9;                  // of inertia, over the moments
constexpr double kLeastLag = 0.005, kMostLag = 1.0;  // [s]
constexpr double kMaxFeetRadius = 0.98;              // of the hull's radius
constexpr double kFeetShare = 0.6;                   // of the hull's radius
constexpr double kFeetClearance = 0.35;    // hull above soles, over the feet's distance from z_B
constexpr double kLeastHullHeight = 0.01;  // [m]

Eigen::Vector3d Vec3(const mjtNum* p) { return {p[0], p[1], p[2]}; }

std::string Quoted(const mjModel& m, int address, const char* kind, int index) {
  const std::string name = m.names + address;
  const std::string word = kind;
  return name.empty() ? word + " " + std::to_string(index) : word + " \"" + name + "\"";
}

struct Motor {
  estimation::Actuator actuator;
  double lag = 0.0;  // [s]
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
  Import(const mjModel& m, const AirframeExtras& extras, VehicleFindings* findings)
      : m_(m), data_(MakeMujocoData(m)), d_(*data_), extras_(extras), findings_(*findings) {
    CallMujoco([&] { mj_kinematics(&m_, data_.get()); });
    FindBase();
    if (base_ < 0) return;
    ReadMass();
    ReadMotors();
    ReadOutline();
    SetBody();
    if (!findings_.faults().empty()) return;
    SetMoments();
    SetSenses();
  }

  std::string Text() const;

 private:
  void SetBody();

  void Fault(std::string what, std::string remedy) {
    findings_.Fault(std::move(what), std::move(remedy));
  }

  void FindBase() {
    int free_joints = 0;
    for (int j = 0; j < m_.njnt; ++j) {
      if (m_.jnt_type[j] != mjJNT_FREE) {
        Fault(Quoted(m_, m_.name_jntadr[j], "joint", j) + " moves",
              "allowed is one free joint alone; take the joint out, its body then stands still");
        continue;
      }
      const int dof = m_.jnt_dofadr[j];
      CheckNothingHolds(Quoted(m_, m_.name_jntadr[j], "joint", j), m_.jnt_stiffness[j], dof);
      base_ = m_.jnt_bodyid[j];
      ++free_joints;
    }
    if (free_joints != 1) {
      Fault("it has " + std::to_string(free_joints) + " free joints",
            "allowed is 1: the body that flies has a <freejoint/>");
    }
    if (base_ < 0) return;
    R_WB_ = Eigen::Map<const Matrix>(d_.xmat + 9 * base_);
  }

  // What the free joint adds to inertia and drag would be lost.
  void CheckNothingHolds(const std::string& joint, double stiffness, int dof) {
    for (int i = dof; i < dof + 6; ++i) {
      const char* has = m_.dof_damping[i] != 0.0        ? "damping"
                        : m_.dof_armature[i] != 0.0     ? "armature"
                        : m_.dof_frictionloss[i] != 0.0 ? "frictionloss"
                        : stiffness != 0.0              ? "stiffness"
                                                        : nullptr;
      if (has != nullptr) {
        Fault(joint + " has " + has,
              "take it out, it would be lost; drag is a matter of airframe.rotor_drag");
        return;
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
    if (!(mass_ > 0.0)) {
      Fault("it has no mass", "give the body an <inertial>, or its geoms a mass");
      return;
    }
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
    inertia_ = R_WB_.transpose() * inertia * R_WB_;
  }

  // The actuator's force before its gear, as MuJoCo clamps it: control, activation, gain, force.
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

  void ReadMotors() {
    if (m_.nu < estimation::kLeastActuators || m_.nu > estimation::kMostActuators) {
      Fault("it has " + std::to_string(m_.nu) + " actuators",
            "allowed are 4 to 8: one a rotor, or one thrust and three moments");
      return;
    }
    for (int i = 0; i < m_.nu; ++i) {
      if (const std::optional<Motor> motor = ReadMotor(i)) motors_.push_back(*motor);
    }
    if (static_cast<int>(motors_.size()) == m_.nu) CheckLags();
  }

  // Its effect on the body, from the force and the moment of its gear in the site's frame.
  std::optional<Motor> ReadMotor(int i) {
    const std::string name = Quoted(m_, m_.name_actuatoradr[i], "actuator", i);
    const std::size_t before = findings_.faults().size();
    const int site = m_.actuator_trnid[2 * i];
    if (m_.actuator_trntype[i] != mjTRN_SITE || !OfVehicle(m_.site_bodyid[site])) {
      Fault(name + " does not act on a site of the vehicle",
            "give it a site at the rotor's hub and the gear \"0 0 1 0 0 k\"");
      return std::nullopt;
    }
    const mjtNum* gear = m_.actuator_gear + 6 * i;
    const Matrix R_WS = Eigen::Map<const Matrix>(d_.site_xmat + 9 * site);
    const Eigen::Matrix3d R_BS = R_WB_.transpose() * R_WS;
    const Eigen::Vector3d force_B = R_BS * Vec3(gear), moment_B = R_BS * Vec3(gear + 3);
    const double push = force_B.norm();
    if (!force_B.allFinite() || !moment_B.allFinite()) {
      Fault(name + " has a gear that is not finite", "give it numbers");
    }
    if (push > 0.0 && std::abs(force_B.z()) < kUpright * push) {
      Fault(name + " does not push along the z axis of the body with the free joint",
            "its gear is \"0 0 f 0 0 k\", and its site's z axis that of the body");
    }
    if (push == 0.0 && !(moment_B.norm() > 0.0)) {
      Fault(name + " has a gear of zeros", "\"0 0 f 0 0 k\" is a rotor, \"0 0 0 x y z\" a moment");
    }
    if (m_.actuator_gaintype[i] != mjGAIN_FIXED || m_.actuator_biastype[i] != mjBIAS_NONE) {
      Fault(name + " has no fixed gain, or a bias", "make it a <motor>");
    }
    if (m_.actuator_trnid[2 * i + 1] >= 0) {
      Fault(name + " has a refsite", "take it out: a motor acts on one site");
    }
    if (m_.actuator_ctrllimited[i] == 0) {
      Fault(name + " has no ctrlrange", "give it the least and the greatest control");
    }
    Motor motor;
    motor.lag = extras_.rotor_lag;
    if (m_.actuator_dyntype[i] == mjDYN_FILTER) {
      motor.lag = m_.actuator_dynprm[mjNDYN * i];
    } else if (m_.actuator_dyntype[i] != mjDYN_NONE) {
      Fault(name + " has dynamics that are no lag", "allowed is dyntype none or filter");
    }
    if (!(motor.lag >= kLeastLag && motor.lag <= kMostLag)) {
      Fault(name + " lags by " + Figure(motor.lag) + " s", "allowed is 0.005 to 1 s");
    }
    if (findings_.faults().size() != before) return std::nullopt;
    // A unit of its command is a newton. For an actuator that makes a moment alone it is a newton
    // metre.
    const double unit = push > 0.0 ? force_B.z() : moment_B.norm();
    const std::array<double, 2> force = ForceRange(i);
    estimation::Actuator& actuator = motor.actuator;
    actuator.p_BR = ToB(Vec3(d_.site_xpos + 3 * site));
    actuator.thrust = push > 0.0 ? 1.0 : 0.0;
    actuator.moment_B = moment_B / unit;
    actuator.min = std::min(unit * force[0], unit * force[1]);
    actuator.max = std::max(unit * force[0], unit * force[1]);
    if (!std::isfinite(actuator.min) || !std::isfinite(actuator.max)) {
      Fault(name + " has a range that is not finite", "give it a ctrlrange");
      return std::nullopt;
    }
    if (push > 0.0 && !(actuator.min >= 0.0 && actuator.max > actuator.min)) {
      Fault(name + " pushes with " + Figure(actuator.min) + " to " + Figure(actuator.max) +
                " N along z",
            "allowed is a range above 0: look at ctrlrange, forcerange and the gear's sign");
      return std::nullopt;
    }
    if (push == 0.0 && !(actuator.min < 0.0 && actuator.max > 0.0)) {
      Fault(name + " turns with " + Figure(actuator.min) + " to " + Figure(actuator.max) + " N m",
            "allowed is a range about 0: look at its ctrlrange");
      return std::nullopt;
    }
    return motor;
  }

  void CheckLags() {
    for (std::size_t i = 1; i < motors_.size(); ++i) {
      if (std::abs(motors_[i].lag - motors_[0].lag) <= kSame * motors_[0].lag) continue;
      Fault(Quoted(m_, m_.name_actuatoradr[i], "actuator", static_cast<int>(i)) + " lags by " +
                Figure(motors_[i].lag) + " s, the first one by " + Figure(motors_[0].lag) + " s",
            "give all the same");
    }
  }

  bool CanSteer() const {
    estimation::VehicleModel model;
    model.mass_kg = mass_;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia_);
    model.inertia = principal.eigenvalues();
    model.R_BI = principal.eigenvectors();
    for (const Motor& motor : motors_) model.actuators.push_back(motor.actuator);
    try {
      return TurnsEnough(model);
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

  // The senses that the user gives. Else, on request and if the file's senses cannot steer, senses that alternate
  // around the body.
  void SetSenses() {
    std::vector<estimation::Actuator*> rotors;
    for (Motor& motor : motors_) {
      if (motor.actuator.thrust > 0.0) rotors.push_back(&motor.actuator);
    }
    const std::vector<double>& given = extras_.rotor_senses;
    if (rotors.size() != motors_.size()) {
      if (given.empty()) return;
      return Fault("airframe.rotor_senses has no effect: the file has moments for actuators",
                   "take it out");
    }
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      if (rotors[i]->moment_B.z() != 0.0) continue;
      Fault(Quoted(m_, m_.name_actuatoradr[i], "actuator", static_cast<int>(i)) +
                " has no reaction torque",
            "give it in the gear, \"0 0 f 0 0 k\", with a sign");
    }
    if (!findings_.faults().empty()) return;
    const auto turn = [](estimation::Actuator& rotor, double sense) {
      rotor.moment_B.z() = std::copysign(rotor.moment_B.z(), sense);
    };
    if (!given.empty()) {
      if (given.size() != rotors.size()) {
        return Fault("airframe.rotor_senses has " + std::to_string(given.size()) +
                         " senses, the vehicle " + std::to_string(rotors.size()) + " rotors",
                     "give one a rotor, in the order of the file's actuators");
      }
      for (std::size_t i = 0; i < rotors.size(); ++i) turn(*rotors[i], given[i]);
      return;
    }
    if (!extras_.alternate_senses || CanSteer()) return;
    const std::vector<Motor> before = motors_;
    std::vector<std::size_t> around(rotors.size());
    std::iota(around.begin(), around.end(), 0);
    const auto azimuth = [&](std::size_t i) {
      return std::atan2(rotors[i]->p_BR.y(), rotors[i]->p_BR.x());
    };
    std::sort(around.begin(), around.end(),
              [&](std::size_t a, std::size_t b) { return azimuth(a) < azimuth(b); });
    // The first rotor of the file keeps its sense.
    const auto first = std::find(around.begin(), around.end(), 0u) - around.begin();
    const double sense = rotors[0]->moment_B.z();
    for (std::size_t k = 0; k < around.size(); ++k) {
      const bool as_first = (static_cast<std::ptrdiff_t>(k) - first) % 2 == 0;
      turn(*rotors[around[k]], as_first ? sense : -sense);
    }
    if (!CanSteer()) {  // the senses are not the fault
      motors_ = before;
      return;
    }
    std::string signs;
    for (const estimation::Actuator* rotor : rotors) {
      signs.append(signs.empty() ? "" : ", ").append(rotor->moment_B.z() > 0.0 ? "1" : "-1");
    }
    findings_.Warn(
        "the file's senses of rotation cannot make a yaw moment; they were made to alternate "
        "around the body",
        "look whether your rotors turn so: airframe.rotor_senses: [" + signs + "]");
  }

  // The user's values for actuators that make a moment alone, each for the axis about which it turns most.
  void SetMoments() {
    if (extras_.moment_max.isZero()) return;
    bool any = false;
    for (Motor& motor : motors_) {
      if (motor.actuator.thrust > 0.0) continue;
      Eigen::Index axis = 0;
      motor.actuator.moment_B.cwiseAbs().maxCoeff(&axis);
      motor.actuator.max = extras_.moment_max(axis);
      motor.actuator.min = -motor.actuator.max;
      any = true;
      if (!(motor.actuator.max > 0.0)) {
        Fault("airframe.moment_max has a zero", "give the greatest moment about x, y and z");
        return;
      }
    }
    if (!any) Fault("airframe.moment_max has no effect: the file has rotors", "take it out");
  }

  void ReadOutline() {
    for (int geom = 0; geom < m_.ngeom; ++geom) {
      if (!OfVehicle(m_.geom_bodyid[geom])) continue;
      for (const Eigen::Vector3d& p_W : PointsAround(m_, d_, geom)) outline_.Hold(ToB(p_W));
    }
    for (const Motor& motor : motors_) outline_.Hold(motor.actuator.p_BR);
  }

  Eigen::Vector3d ToB(const Eigen::Vector3d& p_W) const {
    return R_WB_.transpose() * (p_W - p_WB_);
  }

  const mjModel& m_;
  MujocoData data_;
  const mjData& d_;
  AirframeExtras extras_;
  VehicleFindings& findings_;
  int base_ = -1;
  Eigen::Matrix3d R_WB_ = Eigen::Matrix3d::Identity();
  double mass_ = 0.0;
  Eigen::Vector3d p_WB_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia_ = Eigen::Matrix3d::Zero();
  std::vector<Motor> motors_;
  Outline outline_;
  double radius_ = 0.0, bottom_ = 0.0, top_ = 0.0;  // of the hull [m]
  double feet_at_ = 0.0, depth_ = 0.0;              // [m]
};

std::string InertiaText(const Eigen::Matrix3d& inertia) {
  const Eigen::Vector3d products(inertia(0, 1), inertia(0, 2), inertia(1, 2));
  const Eigen::Vector3d moments = inertia.diagonal();
  if (products.cwiseAbs().maxCoeff() <= kNoProduct * moments.minCoeff()) {
    return "diaginertia='" + VectorText(moments) + "'";
  }
  return "fullinertia='" + VectorText(moments) + " " + VectorText(products) + "'";
}

// The colliding cylinder and the feet: the user's, or fitted around the geoms.
void Import::SetBody() {
  const bool own_hull = !extras_.hull.isZero(), own_feet = !extras_.feet.isZero();
  radius_ = own_hull ? extras_.hull[0] : outline_.radius;
  bottom_ = own_hull ? extras_.hull[1] : outline_.bottom;
  top_ = own_hull ? extras_.hull[2] : std::max(outline_.top, bottom_ + kLeastHullHeight);
  feet_at_ = own_feet ? extras_.feet[0] : kFeetShare * radius_;
  depth_ = own_feet ? extras_.feet[1] : -bottom_ + kFeetClearance * feet_at_;
  const auto within = [&](const char* what, double value, double high, const char* remedy) {
    if (value > 0.0 && value <= high) return;
    Fault(what + (" is " + Figure(value)), "allowed is above 0 and up to " + Figure(high) + remedy);
  };
  within("radius of the hull [m]", radius_, 5.0, "; look at the geoms, or give airframe.hull");
  within("height of the hull [m]", top_ - bottom_, 5.0,
         "; look at the geoms, or give airframe.hull");
  within("distance of the feet from the middle [m]", feet_at_, kMaxFeetRadius * radius_,
         ": airframe.feet");
  within("depth of the feet below the hull [m]", depth_ + bottom_, 5.0, ": airframe.feet");
}

std::string Import::Text() const {
  const double radius = radius_, bottom = bottom_, top = top_, at = feet_at_, depth = depth_;
  const double ball = std::min({0.015, 0.1 * radius, 0.5 * (depth + bottom), radius - at});

  std::ostringstream xml;
  xml << "<mujoco model='imported vehicle'>\n<custom>\n<numeric name='rotor_drag' data='"
      << VectorText({extras_.rotor_drag, extras_.rotor_drag, 0.0})
      << "'/>\n<numeric name='body_drag_area' data='" << NumberText(extras_.body_drag_area)
      << "'/>\n</custom>\n<worldbody>\n<body name='vehicle' pos='0 0 1'>\n"
      << "<freejoint name='vehicle'/>\n<inertial pos='0 0 0' mass='" << NumberText(mass_) << "' "
      << InertiaText(inertia_) << "/>\n"
      << "<geom name='hull' type='cylinder' size='" << NumberText(radius) << " "
      << NumberText(0.5 * (top - bottom)) << "' pos='0 0 " << NumberText(0.5 * (top + bottom))
      << "' condim='3' friction='0.6 0.005 0.0001' group='3' rgba='0.5 0.5 0.5 0.3'/>\n";
  for (int i = 0; i < 4; ++i) {
    const double angle = (0.25 + 0.5 * i) * std::numbers::pi;
    xml << "<geom name='foot" << i << "' type='sphere' size='" << NumberText(ball) << "' pos='"
        << VectorText({at * std::cos(angle), at * std::sin(angle), ball - depth})
        << "' condim='4' friction='1 0.005 0.0001' rgba='0.1 0.1 0.1 1'/>\n";
  }
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    xml << "<site name='rotor" << i << "' pos='" << VectorText(motors_[i].actuator.p_BR) << "'/>\n";
  }
  xml << "</body>\n</worldbody>\n<actuator>\n";
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const estimation::Actuator& actuator = motors_[i].actuator;
    xml << "<general name='rotor" << i << "' site='rotor" << i << "' gear='0 0 "
        << NumberText(actuator.thrust) << " " << VectorText(actuator.moment_B)
        << "' ctrllimited='true' ctrlrange='" << NumberText(actuator.min) << " "
        << NumberText(actuator.max) << "' dyntype='filter' dynprm='" << NumberText(motors_[0].lag)
        << "' gaintype='fixed' gainprm='1' biastype='none'/>\n";
  }
  xml << "</actuator>\n</mujoco>\n";
  return xml.str();
}

bool OwnForm(const mjModel& m) {
  return mj_name2id(&m, mjOBJ_BODY, "vehicle") >= 0 && mj_name2id(&m, mjOBJ_GEOM, "hull") >= 0;
}

}  // namespace

bool IsInOwnForm(const std::string& path) { return OwnForm(*CompileMjcfFile(path)); }

std::string ImportVehicle(const std::string& path, const AirframeExtras& extras,
                          VehicleFindings* findings) {
  std::string text = ReadVehicleFile(path);
  const MujocoModel model = CompileMjcfFile(path);
  if (OwnForm(*model)) return text;
  const Import import(*model, extras, findings);
  return findings->faults().empty() ? import.Text() : "";
}

std::string ImportVehicle(const std::string& path, const AirframeExtras& extras) {
  VehicleFindings findings;
  std::string text = ImportVehicle(path, extras, &findings);
  findings.ThrowFaults();
  return text;
}

}  // namespace touchdown::sim
