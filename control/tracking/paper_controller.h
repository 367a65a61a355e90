// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/control/tracking/controller.h"

namespace touchdown::control {

/// The paper's law (eq. 19-22): force from position and velocity error plus the reference's
/// acceleration, moment proportional to the small-angle attitude error. Eq. 21 is printed without
/// rate damping, and is then unstable. Its source (the paper's [14]) has damping. It is kept here,
/// on the body rate itself, without feed-forward of rate or drag.
class PaperController final : public Controller {
 public:
  /// Throws std::invalid_argument for a model or an option out of range.
  explicit PaperController(const estimation::VehicleModel& model,
                           const ControllerOptions& options = {});

  ControlOutput Update(const estimation::VehicleState& state, const planning::FlatState& reference,
                       const Disturbance& disturbance, double tilt_most) const noexcept override;

 private:
  estimation::VehicleModel model_;
  ControllerOptions options_;
  double thrust_max_ = 0.0;  ///< without a moment [N]
};

}  // namespace touchdown::control
