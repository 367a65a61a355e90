// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::control {

/// The command of each actuator, in the order of VehicleModel::actuators.
struct MixerOutput {
  estimation::Commands thrusts;  ///< within the actuators' limits [N], of moments [N m]
  bool saturated = false;        ///< the wrench could not be had in full
};

/// Wrench to commands for any four to eight actuators (eq. 8 generalised). Where the limits forbid
/// the whole wrench, roll and pitch moment come first, then collective thrust, then yaw moment. For
/// them the thrust is raised at most to kRaisedThrust of the way from the least to hover. If every
/// attitude correction lifted the vehicle, it would leave its path.
class Mixer {
 public:
  static constexpr double kRaisedThrust = 0.5;  ///< [-]

  /// Throws std::invalid_argument as estimation::AllocationOf does.
  explicit Mixer(const estimation::VehicleModel& model);

  /// Does not allocate. A wrench that is not finite gives every rotor the least thrust, and no
  /// other moment.
  MixerOutput Mix(const Wrench& wrench) const noexcept;

  /// The wrench that the commands produce.
  Wrench Apply(const estimation::Commands& thrusts) const noexcept;

  /// Commands that make a thrust [N] without a moment, whatever the limits.
  estimation::Commands Level(double thrust) const noexcept;

  /// Of the commands; their number says how many there are.
  const estimation::Commands& min() const { return min_; }
  const estimation::Commands& max() const { return max_; }

 private:
  using Commands = estimation::Commands;

  // The end of an actuator's range at which it allows no less, or no more, thrust.
  double AtLeastThrust(Eigen::Index i) const {
    return allocation_.Shares()(i) > 0.0 ? min_(i) : max_(i);
  }
  double AtMostThrust(Eigen::Index i) const {
    return allocation_.Shares()(i) > 0.0 ? max_(i) : min_(i);
  }

  estimation::Allocation allocation_;
  Commands min_, max_;
  double raised_thrust_;  ///< up to which moments may raise the thrust [N]
};

}  // namespace touchdown::control
