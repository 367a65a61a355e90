// SPDX-License-Identifier: BSD-3-Clause
// Both laws' desired force is linear in reference and disturbance (the paper's eq. 19). The
// reference moves to the vehicle itself, which removes the position loop. An acceleration of -(1 -
// share) g leaves the rotors that share of the weight, along the vertical. Velocities are removed
// from both sides, and with them the drag that is fed forward. Friction then holds the vehicle
// against the wind of the drive and any other, and the attitude loop levels it about the feet that
// touch. Most of the damping is left to the feet: rotors that answer each knock of the deck lift
// the feet off it. The deck levels the vehicle before its demand does, and then the thrust no
// longer holds it against the wind. On rotors that still carry most of the weight it would slide,
// so the fade is short.

#include "control/tracking/settling.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::control {

namespace {

constexpr double kDampingTakenOut = 0.6;  // of the attitude loop's, standing

}  // namespace

Settling::Settling(const SettlingParameters& parameters) : parameters_(parameters) {
  const auto require = [](bool good, const char* name, double value, const char* range) {
    if (good) return;
    throw std::invalid_argument(std::string("SettlingParameters.") + name + " = " +
                                std::to_string(value) + ", allowed: " + range);
  };
  const SettlingParameters& p = parameters;
  require(p.fade_time > 0.0, "fade_time", p.fade_time, "> 0 s");
  require(p.return_time > 0.0, "return_time", p.return_time, "> 0 s");
  require(p.thrust_share > 0.0 && p.thrust_share < 1.0, "thrust_share", p.thrust_share, "(0, 1)");
  require(p.contact_gap >= 0.0, "contact_gap", p.contact_gap, ">= 0 s");
}

void Settling::Note(double t, bool touching, bool landing) noexcept {
  share_ = Share(t);
  t_ = t;
  if (touching) last_contact_ = t;
  stands_ = landing && (touching || (stands_ && t - last_contact_ <= parameters_.contact_gap));
  rate_ = stands_ ? 1.0 / parameters_.fade_time : -1.0 / parameters_.return_time;
}

double Settling::Share(double t) const noexcept {
  return std::clamp(share_ + rate_ * (t - t_), 0.0, 1.0);
}

void Settling::Apply(estimation::VehicleState* state, planning::FlatState* reference,
                     Disturbance* disturbance) const noexcept {
  const double share = Share(state->t);
  if (share == 0.0) return;
  const Eigen::Vector3d a_standing =
      -(1.0 - parameters_.thrust_share) * estimation::kGravity * Eigen::Vector3d::UnitZ();
  reference->p_WB += share * (state->p_WB - reference->p_WB);
  reference->v_WB *= 1.0 - share;
  state->v_WB *= 1.0 - share;
  state->w_WB_B *= 1.0 - kDampingTakenOut * share;
  reference->a_WB += share * (a_standing - reference->a_WB);
  reference->j_WB *= 1.0 - share;
  disturbance->force_W *= 1.0 - share;
  disturbance->moment_B *= 1.0 - share;
}

}  // namespace touchdown::control
