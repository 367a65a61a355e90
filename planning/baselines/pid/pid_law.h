// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/planning/spline/limits.h"

namespace touchdown::planning {

/// Gains of the track-then-descend baseline, from a position error to a velocity. The
/// flights that chose the defaults: docs/results/ego/tables.md.
struct PidGains {
  double proportional = 2.0;  ///< horizontal, of the position error [1/s]
  double integral = 0.2;      ///< of its integral [1/s^2]
  double derivative = 0.1;    ///< of its rate [-]
  /// The integral adds no more: the velocity of an error of 0.25 m [m/s].
  double integral_limit = 0.5;
  /// Farther from the pad the integral stands still [m]: the distance at which the mission descends.
  double integral_zone = 0.5;
  double height = 1.0;     ///< proportional gain of the height [1/s]
  double response = 0.25;  ///< time constant with which a velocity is taken up [s]
};

/// Throws std::invalid_argument naming the first gain out of its range.
void Validate(const PidGains& gains);

/// The law's input on the pad, horizontally, all in W.
struct PidError {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();      ///< pad less vehicle [m]
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();      ///< pad less vehicle [m/s]
  Eigen::Vector2d pad_velocity = Eigen::Vector2d::Zero();  ///< fed forward [m/s]
};

/// The law: v = v_pad + P e + I integral(e) + D de/dt. It is cut at the speed limit and followed
/// with the time constant `response` under the acceleration limit. Anti-windup: the integral is
/// bounded. It stands still while either limit cuts or the pad is farther than its zone: it would
/// be full on arrival.
class PidLaw {
 public:
  /// Throws std::invalid_argument as Validate does.
  explicit PidLaw(const PidGains& gains);

  void Reset() { integral_.setZero(); }

  /// Acceleration of the reference [m/s^2] over the next dt [s] from its velocity `v` [m/s]. `v_z`
  /// is the vertical velocity that the height law demands [m/s]. A reference within the limits
  /// stays there if dt is no longer than `response`.
  Eigen::Vector3d Step(const PidError& error, double v_z, const Eigen::Vector3d& v,
                       const Limits& limits, double dt);

  /// The same towards a given velocity, without feedback.
  Eigen::Vector3d Towards(const Eigen::Vector3d& v_wanted, const Eigen::Vector3d& v,
                          const Limits& limits) const;

  /// What the integral adds to the velocity at present [m/s].
  const Eigen::Vector2d& integral() const { return integral_; }
  const PidGains& gains() const { return gains_; }

 private:
  PidGains gains_;
  Eigen::Vector2d integral_ = Eigen::Vector2d::Zero();
};

}  // namespace touchdown::planning
