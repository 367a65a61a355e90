// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "control/tracking/mixer.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::control {

/// Rotors follow their command with a lag. A command that exceeds the wanted thrust, in proportion
/// to what is still missing, makes them follow sooner. The lead k acts as if the lag were 1 / (1 +
/// k) of its length. The lag reduces the attitude's damping. Not to be shared between threads.
class RotorLead {
 public:
  /// Rotors start at the model's hover thrust.
  explicit RotorLead(const estimation::VehicleModel& model);

  /// The rotors have been told `thrusts` [N] for long. Before the first Command.
  void Hover(const estimation::Commands& thrusts) noexcept;

  /// The command with which the rotors are told from time t [s] on to give `thrusts` [N]: within their
  /// limits (Mixer). Once per control step, in time order. Does not allocate.
  estimation::Commands Command(const estimation::Commands& thrusts, double t) noexcept;

 private:
  double lag_;  ///< of the model [s]
  Mixer mixer_;
  double t_ = 0.0;
  bool started_ = false;
  estimation::Commands given_;  ///< by the rotors, as the model has it [N]
  estimation::Commands commanded_;
};

}  // namespace touchdown::control
