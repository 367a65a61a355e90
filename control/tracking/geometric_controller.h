// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/control/tracking/controller.h"

namespace touchdown::control {

/// Geometric tracking control on SE(3) (Lee, Leok, McClamroch 2010), with the attitude error on
/// SO(3). The body rate is fed forward from the reference's jerk, known linear rotor drag on the
/// reference's velocity. The given disturbance is compensated.
class GeometricController final : public Controller {
 public:
  /// Throws std::invalid_argument for a model or an option out of range.
  explicit GeometricController(const estimation::VehicleModel& model,
                               const ControllerOptions& options = {});

  ControlOutput Update(const estimation::VehicleState& state, const planning::FlatState& reference,
                       const Disturbance& disturbance, double tilt_most) const noexcept override;

 private:
  estimation::VehicleModel model_;
  ControllerOptions options_;
  double thrust_max_ = 0.0;  ///< without a moment [N]
};

}  // namespace touchdown::control
