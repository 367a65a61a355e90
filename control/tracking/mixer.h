// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::control {

/// Four rotor thrusts, in the order of VehicleModel::rotors.
struct MixerOutput {
  Eigen::Vector4d thrusts = Eigen::Vector4d::Zero();  ///< within the rotor's limits [N]
  bool saturated = false;                             ///< the wrench could not be had in full
};

/// Wrench to rotor thrusts for any four-rotor geometry (eq. 8 generalised). Where the limits forbid
/// the whole wrench, roll and pitch moment come first, then collective thrust, then yaw moment. For them the
/// thrust is raised to kRaisedThrust of the way from the rotors' least to hover at most: a vehicle that every correction of its attitude lifts leaves
/// its way.
class Mixer {
 public:
  static constexpr double kRaisedThrust = 0.5;  ///< [-]

  /// Throws std::invalid_argument if the rotors cannot produce every wrench, or hover without
  /// moment would need a rotor to pull down.
  explicit Mixer(const estimation::VehicleModel& model);

  /// Does not allocate. A wrench that is not finite gives every rotor the least thrust.
  MixerOutput Mix(const Wrench& wrench) const noexcept;

  /// The wrench that the thrusts [N] produce.
  Wrench Apply(const Eigen::Vector4d& thrusts) const noexcept;

 private:
  Eigen::Matrix4d wrench_from_thrusts_;  ///< rows: thrust, moment x, y, z
  Eigen::Matrix4d thrusts_from_wrench_;
  double min_;
  double max_;
  double raised_thrust_;  ///< up to which moments may raise the thrust [N]
};

}  // namespace touchdown::control
