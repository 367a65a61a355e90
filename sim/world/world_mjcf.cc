// SPDX-License-Identifier: BSD-3-Clause
// The scene as MJCF text. Choices, each measured in MuJoCo 2.2.2:
// - Euler with 2 ms, Newton, elliptic cone, impratio 10: a landed vehicle creeps 0.05 mm in 13 s.
// - The pad is on slide and hinge joints with velocity drives: a mocap body shows contact a surface at rest.
// - No obstacles: their touch is found elsewhere (obstacle_touch.h).
// - The pad's stateless actuators come before the rotors' stateful ones: the compiler demands it.
// - nconmax and njmax are small: they bound the memory of mjData.
// Everything but the vehicle has contype 1 and conaffinity 0: it touches only the vehicle. No angle is written in
// degrees or radians, so that the vehicle file's <compiler> cannot matter.

#include "sim/world/world_mjcf.h"

#include <sstream>
#include <string>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mjcf_text.h"
#include "sim/mujoco/mujoco_model.h"

namespace touchdown::sim {
namespace {

constexpr char kEnvironment[] =
    "contype='1' conaffinity='0' solref='0.02 1' solimp='0.9 0.95 0.001 0.5 2' margin='0' ";

void WritePad(const WorldConfig& config, std::ostream& xml) {
  const double height = config.pad_motion.p_start.z();
  // The body's frame is the pad's: origin at the centre of the deck's upper face.
  estimation::PadState at_origin;
  at_origin.p_WP.z() = height;
  const Eigen::Vector3d origin = at_origin.p_WP;
  const Box deck = DeckBox(config.pad, at_origin);
  const Box body = PadBodyBox(config.pad, at_origin);
  xml << "<body name='pad' pos='" << VectorText(origin) << "'>\n"
      << "<joint name='pad_x' type='slide' axis='1 0 0' limited='false'/>\n"
      << "<joint name='pad_y' type='slide' axis='0 1 0' limited='false'/>\n"
      << "<joint name='pad_yaw' type='hinge' axis='0 0 1' limited='false'/>\n"
      << "<inertial pos='" << VectorText(body.center - origin) << "' mass='"
      << estimation::NumberText(PadDrive::kMass) << "' diaginertia='"
      << VectorText(Eigen::Vector3d::Constant(PadDrive::YawInertia(config.pad)))
      << "'/>\n"
      // Priority: the deck's own friction holds, whatever the vehicle's feet say.
      << "<geom name='deck' type='box' size='" << VectorText(deck.half_extents) << "' pos='"
      << VectorText(deck.center - origin) << "' " << kEnvironment
      << "condim='4' priority='1' friction='" << estimation::NumberText(config.pad.friction)
      << " 0.005 0.0001'/>\n"
      << "<geom name='pad_body' type='box' size='" << VectorText(body.half_extents) << "' pos='"
      << VectorText(body.center - origin) << "' " << kEnvironment << "condim='3'/>\n"
      << "</body>\n";
}

void WriteDrive(const char* joint, double gain, std::ostream& xml) {
  xml << "<velocity name='" << joint << "' joint='" << joint << "' kv='"
      << estimation::NumberText(gain) << "' ctrllimited='false' forcelimited='false'/>\n";
}

}  // namespace

std::string WorldMjcf(const WorldConfig& config) {
  std::ostringstream xml;
  xml << "<mujoco model='touchdown world'>\n"
      << "<worldbody>\n"
      << "<geom name='ground' type='plane' size='0 0 1' pos='0 0 0' condim='3' " << kEnvironment
      << "/>\n";
  WritePad(config, xml);
  xml << "</worldbody>\n<actuator>\n";
  WriteDrive("pad_x", PadDrive::kVelocityGain, xml);
  WriteDrive("pad_y", PadDrive::kVelocityGain, xml);
  WriteDrive("pad_yaw", PadDrive::kYawGain, xml);
  xml << "</actuator>\n"
      << "<include file='" << kVehicleIncludeName
      << "'/>\n"
      // After the include: these hold against whatever the vehicle file says.
      << "<option timestep='" << estimation::NumberText(config.timestep) << "' gravity='0 0 -"
      << estimation::NumberText(estimation::kGravity) << "' integrator='Euler' solver='Newton' "
      << "cone='elliptic' impratio='10' density='0' viscosity='0' wind='0 0 0'/>\n"
      << "<size nconmax='100' njmax='500'/>\n"
      << "</mujoco>\n";
  return xml.str();
}

}  // namespace touchdown::sim
