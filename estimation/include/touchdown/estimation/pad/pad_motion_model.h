// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::estimation {

using PadVector = Eigen::Matrix<double, 5, 1>;
using PadMatrix = Eigen::Matrix<double, 5, 5>;

/// The assumed motion of the pad. Every motion uses the same five-vector. Entries that a motion
/// does not have are exactly zero, with zero covariance.
enum class PadMotion {
  kVelocity,  ///< [Px, Py, Vx, Vy, 0]: heading not known yet, straight at constant velocity
  kHeading,   ///< [Px, Py, V, phi, 0]: the paper's state (eq. 9), straight along its heading
  kTurn,      ///< [Px, Py, V, phi, omega]: coordinated turn, a circular arc
};

/// Number of leading entries that the motion uses: 4, 4 or 5.
int StateSize(PadMotion motion);
/// "velocity", "heading" or "turn".
const char* ToString(PadMotion motion);

/// One-sided spectral densities of the white noise that drives the pad's motion.
struct PadNoise {
  double position = 1e-5;      ///< of the position's rate, each axis [m^2/s]
  double velocity = 0.06;      ///< of the velocity's rate, each axis, kVelocity only [m^2/s^3]
  double acceleration = 0.03;  ///< of the speed's rate, along the heading [m^2/s^3]
  double heading = 0.02;       ///< of the heading's rate, kHeading only [rad^2/s]
  double turn = 0.004;         ///< of the turn rate's rate, kTurn only [rad^2/s^3]
};

/// Gaussian belief about the pad at one instant. V is signed: a pad that reverses keeps its heading
/// and has V < 0. (V, phi) and (-V, phi + pi) describe the same motion.
struct PadBelief {
  double t = 0.0;  ///< [s]
  PadMotion motion = PadMotion::kVelocity;
  PadVector mean = PadVector::Zero();  ///< SI units: m, m/s, rad, rad/s; phi unwrapped
  PadMatrix cov = PadMatrix::Zero();
};

/// Mean after dt seconds (either sign), in closed form, exact also as omega -> 0.
PadVector Propagate(PadMotion motion, const PadVector& mean, double dt);

/// Derivative of Propagate with respect to the mean, 5x5.
PadMatrix PropagateJacobian(PadMotion motion, const PadVector& mean, double dt);

/// Covariance that the noise adds over |dt| seconds, along the nonlinear motion of the mean.
PadMatrix ProcessNoise(PadMotion motion, const PadVector& mean, double dt, const PadNoise& noise);

/// Belief at time t [s], before or after belief.t. Does not allocate.
PadBelief PropagateBelief(const PadBelief& belief, double t, const PadNoise& noise);

/// Position, its exact time derivatives up to jerk, and heading. `height` is the deck's height in W
/// [m]. With kVelocity the yaw is the direction of motion, 0 at standstill.
PadState ToPadState(const PadBelief& belief, double height);

/// Normalised estimation error squared of the whole state, chi-squared with StateSize(motion)
/// degrees of freedom if the belief is consistent. `truth` is in the belief's own coordinates;
/// the heading error is wrapped.
double StateNees(const PadBelief& belief, const PadVector& truth);

/// The same for the horizontal position alone, 2 degrees of freedom. `p_WP` [m].
double PositionNees(const PadState& pad, const Eigen::Vector2d& p_WP);

}  // namespace touchdown::estimation
