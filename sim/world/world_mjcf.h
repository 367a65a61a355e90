// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/world/world.h"

namespace touchdown::sim {

/// The pad vehicle's velocity drives: force = gain * (control - velocity).
struct PadDrive {
  static constexpr double kMass = 40.0;            ///< of the pad vehicle [kg]
  static constexpr double kVelocityGain = 4000.0;  ///< both slides [N s/m]
  static constexpr double kYawGain = 800.0;        ///< hinge [N m s/rad]
  static constexpr double kPositionGain = 1.5;     ///< control = v_ref + this * (p_ref - p) [1/s]

  /// About the hinge, of a slab as long and wide as the body [kg m^2].
  static double YawInertia(const PadGeometry& pad) {
    const double length = pad.body_half_length, width = pad.body_half_width;
    return kMass * (length * length + width * width) / 3.0;
  }
};

/// MJCF text of the world: ground and pad vehicle; the vehicle is included under
/// kVehicleIncludeName. Geoms are named "ground", "deck" and "pad_body"; joints
/// and actuators of the pad "pad_x", "pad_y" and "pad_yaw". The configuration is taken as valid.
std::string WorldMjcf(const WorldConfig& config);

}  // namespace touchdown::sim
