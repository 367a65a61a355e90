// SPDX-License-Identifier: BSD-3-Clause
// Both laws' desired force is linear in reference and disturbance (the paper's eq. 19): moving the
// reference to the vehicle itself takes the position loop out, and an acceleration of
// -(1 - share) g leaves the rotors that share of the weight, along the vertical. The attitude loop
// then levels the vehicle about the feet that touch, and friction holds it against the wind.

#include "touchdown/control/settling.h"

#include <algorithm>

#include "touchdown/estimation/vehicle_model.h"

namespace touchdown::control {

void Settling::Note(double t, bool touching) noexcept {
  if (touching) {
    if (!touching_) since_ = t;
    touching_ = true;
    last_ = t;
  } else if (t - last_ > parameters_.contact_gap) {
    touching_ = false;
  }
}

double Settling::Share(double t) const noexcept {
  return touching_ ? std::clamp((t - since_) / parameters_.fade_time, 0.0, 1.0) : 0.0;
}

void Settling::Apply(const estimation::VehicleState& state, planning::FlatState* reference,
                     Disturbance* disturbance) const noexcept {
  const double share = Share(state.t);
  if (share == 0.0) return;
  const Eigen::Vector3d a_standing =
      -(1.0 - parameters_.thrust_share) * estimation::kGravity * Eigen::Vector3d::UnitZ();
  reference->p_WB += share * (state.p_WB - reference->p_WB);
  reference->v_WB += share * (state.v_WB - reference->v_WB);
  reference->a_WB += share * (a_standing - reference->a_WB);
  reference->j_WB *= 1.0 - share;
  disturbance->force_W *= 1.0 - share;
  disturbance->moment_B *= 1.0 - share;
}

}  // namespace touchdown::control
