// SPDX-License-Identifier: BSD-3-Clause
// A proportional-integral-derivative law from the position relative to the pad to a velocity, like
// the outer loop of common autopilots. The pad's velocity is fed forward. The reference follows the
// velocity with a first-order lag, so that it has an acceleration to be tracked with.

#include "planning/baselines/pid/pid_law.h"

#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

void Require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument(std::string("PidGains: ") + name + " is " + std::to_string(value) +
                              ", it must be " + range);
}

template <typename Vector>
Vector Cut(const Vector& vector, double limit) {
  const double norm = vector.norm();
  return norm > limit ? Vector(vector * (limit / norm)) : vector;
}

}  // namespace

void Validate(const PidGains& gains) {
  Require(gains.proportional > 0.0, "proportional", gains.proportional, "> 0 1/s");
  Require(gains.integral >= 0.0, "integral", gains.integral, ">= 0 1/s^2");
  Require(gains.derivative >= 0.0, "derivative", gains.derivative, ">= 0");
  Require(gains.integral_limit >= 0.0, "integral_limit", gains.integral_limit, ">= 0 m/s");
  Require(gains.integral_zone >= 0.0, "integral_zone", gains.integral_zone, ">= 0 m");
  Require(gains.height > 0.0, "height", gains.height, "> 0 1/s");
  Require(gains.response > 0.0, "response", gains.response, "> 0 s");
}

PidLaw::PidLaw(const PidGains& gains) : gains_(gains) { Validate(gains); }

Eigen::Vector3d PidLaw::Towards(const Eigen::Vector3d& v_wanted, const Eigen::Vector3d& v,
                                const Limits& limits) const {
  const Eigen::Vector3d change = (Cut(v_wanted, limits.speed) - v) / gains_.response;
  return Cut(change, limits.acceleration);
}

Eigen::Vector3d PidLaw::Step(const PidError& error, double v_z, const Eigen::Vector3d& v,
                             const Limits& limits, double dt) {
  Eigen::Vector3d wanted;
  wanted << error.pad_velocity + gains_.proportional * error.position + integral_ +
                gains_.derivative * error.velocity,
      v_z;
  Eigen::Vector3d a = Towards(wanted, v, limits);
  const bool cut =
      wanted.norm() > limits.speed || (wanted - v).norm() > limits.acceleration * gains_.response;
  if (!cut && error.position.norm() < gains_.integral_zone) {
    integral_ = Cut(Eigen::Vector2d(integral_ + gains_.integral * dt * error.position),
                    gains_.integral_limit);
  }
  return a;
}

}  // namespace touchdown::planning
