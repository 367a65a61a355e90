// SPDX-License-Identifier: BSD-3-Clause
// A lead filter (T s + 1) / (T s / (1 + k) + 1) on each rotor's command, T the model's lag. It is made with
// the model's rotor instead of a difference of the command: command = given + (1 + k)(wanted - given).
// What the limits cut off is seen by that rotor too, so that nothing winds up.

#include "touchdown/control/rotor_lead.h"

#include <cmath>

namespace touchdown::control {
namespace {
// With the plant 20 % off in everything the attitude's loop, with the observer and 4 ms of delay, keeps a damping
// ratio of 0.52 in the worst corner (its eigenvalues); with a lead of 1 it is 0.45, without one 0.21.
constexpr double kLead = 2.0;
}  // namespace

RotorLead::RotorLead(const estimation::VehicleModel& model)
    : lag_(model.rotor_lag_s), least_(model.rotor_thrust_min), greatest_(model.rotor_thrust_max) {
  given_.setConstant(0.25 * model.HoverThrust());
  commanded_ = given_;
}

Eigen::Vector4d RotorLead::Command(const Eigen::Vector4d& thrusts, double t) noexcept {
  if (started_ && lag_ > 0.0) given_ += (1.0 - std::exp(-(t - t_) / lag_)) * (commanded_ - given_);
  started_ = true;
  t_ = t;
  commanded_ = (given_ + (1.0 + kLead) * (thrusts - given_)).cwiseMax(least_).cwiseMin(greatest_);
  return commanded_;
}

}  // namespace touchdown::control
