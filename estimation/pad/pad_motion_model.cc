// SPDX-License-Identifier: BSD-3-Clause
// Motions of the pad (the paper's eq. 10 made explicit) in closed form. The coordinated turn is
// integrated as a chord, dt V sinc(omega dt / 2) in the direction phi + omega dt / 2. The chord has
// no singularity at omega = 0; sinc and its derivative use their series there. The process noise is
// the integral of Phi Qc Phi' along the nonlinear motion, by three-point Gauss-Legendre quadrature.
// It is exact for the polynomials (up to s^4) of a straight motion, and always positive
// semidefinite.

#include "touchdown/estimation/pad/pad_motion_model.h"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::estimation {
namespace {

// sin(u)/u and its derivative.
struct Sinc {
  double value;
  double derivative;
};

Sinc EvaluateSinc(double u) {
  const double u2 = u * u;
  // Next terms u^8/362880 and u^7/45360: below rounding for |u| < 0.05.
  if (std::abs(u) < 0.05) {
    return {1.0 - u2 / 6.0 + u2 * u2 / 120.0 - u2 * u2 * u2 / 5040.0,
            u * (-1.0 / 3.0 + u2 / 30.0 - u2 * u2 / 840.0)};
  }
  const double value = std::sin(u) / u;
  return {value, (std::cos(u) - value) / u};
}

PadVector NoiseDensities(PadMotion motion, const PadNoise& noise) {
  PadVector density;
  switch (motion) {
    case PadMotion::kVelocity:
      density << noise.position, noise.position, noise.velocity, noise.velocity, 0.0;
      break;
    case PadMotion::kHeading:
      density << noise.position, noise.position, noise.acceleration, noise.heading, 0.0;
      break;
    case PadMotion::kTurn:
      density << noise.position, noise.position, noise.acceleration, 0.0, noise.turn;
      break;
  }
  return density;
}

}  // namespace

const char* ToString(PadMotion motion) {
  switch (motion) {
    case PadMotion::kVelocity:
      return "velocity";
    case PadMotion::kHeading:
      return "heading";
    case PadMotion::kTurn:
      return "turn";
  }
  return "unknown";
}

int StateSize(PadMotion motion) { return motion == PadMotion::kTurn ? 5 : 4; }

PadVector Propagate(PadMotion motion, const PadVector& mean, double dt) {
  PadVector next = mean;
  if (motion == PadMotion::kVelocity) {
    next.head<2>() += dt * mean.segment<2>(2);
    return next;
  }
  const double u = 0.5 * mean(4) * dt;
  const double chord = mean(2) * dt * EvaluateSinc(u).value;
  next(0) += chord * std::cos(mean(3) + u);
  next(1) += chord * std::sin(mean(3) + u);
  next(3) += mean(4) * dt;
  return next;
}

PadMatrix PropagateJacobian(PadMotion motion, const PadVector& mean, double dt) {
  PadMatrix jacobian = PadMatrix::Identity();
  if (motion == PadMotion::kVelocity) {
    jacobian(0, 2) = dt;
    jacobian(1, 3) = dt;
    return jacobian;
  }
  const double speed = mean(2);
  const double u = 0.5 * mean(4) * dt;
  const Sinc sinc = EvaluateSinc(u);
  const double c = std::cos(mean(3) + u);
  const double s = std::sin(mean(3) + u);
  jacobian(0, 2) = dt * sinc.value * c;
  jacobian(1, 2) = dt * sinc.value * s;
  jacobian(0, 3) = -speed * dt * sinc.value * s;
  jacobian(1, 3) = speed * dt * sinc.value * c;
  jacobian(0, 4) = 0.5 * speed * dt * dt * (sinc.derivative * c - sinc.value * s);
  jacobian(1, 4) = 0.5 * speed * dt * dt * (sinc.derivative * s + sinc.value * c);
  jacobian(3, 4) = dt;
  return jacobian;
}

PadMatrix ProcessNoise(PadMotion motion, const PadVector& mean, double dt, const PadNoise& noise) {
  static constexpr std::array<double, 3> kNodes = {0.11270166537925831, 0.5, 0.88729833462074169};
  static constexpr std::array<double, 3> kWeights = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const PadVector density = NoiseDensities(motion, noise);
  PadMatrix added = PadMatrix::Zero();
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    const double s = kNodes[k] * dt;
    const PadMatrix phi = PropagateJacobian(motion, Propagate(motion, mean, s), dt - s);
    added += (kWeights[k] * std::abs(dt)) * (phi * density.asDiagonal() * phi.transpose());
  }
  return added;
}

PadBelief PropagateBelief(const PadBelief& belief, double t, const PadNoise& noise) {
  const double dt = t - belief.t;
  if (dt == 0.0) return belief;
  PadBelief next = belief;
  const PadMatrix phi = PropagateJacobian(belief.motion, belief.mean, dt);
  next.t = t;
  next.mean = Propagate(belief.motion, belief.mean, dt);
  next.cov = phi * belief.cov * phi.transpose();
  next.cov += ProcessNoise(belief.motion, belief.mean, dt, noise);
  return next;
}

PadState ToPadState(const PadBelief& belief, double height) {
  PadState pad;
  const PadVector& x = belief.mean;
  pad.p_WP << x(0), x(1), height;
  pad.cov_p = belief.cov.topLeftCorner<2, 2>();
  if (belief.motion == PadMotion::kVelocity) {
    pad.v_WP << x(2), x(3), 0.0;
    if (x(2) != 0.0 || x(3) != 0.0) pad.yaw = std::atan2(x(3), x(2));
    return pad;
  }
  const Eigen::Vector3d along(std::cos(x(3)), std::sin(x(3)), 0.0);
  const Eigen::Vector3d left(-along.y(), along.x(), 0.0);
  pad.v_WP = x(2) * along;
  pad.a_WP = x(2) * x(4) * left;
  pad.j_WP = -x(2) * x(4) * x(4) * along;
  pad.yaw = WrapAngle(x(3));
  pad.yaw_rate = x(4);
  return pad;
}

double StateNees(const PadBelief& belief, const PadVector& truth) {
  PadVector error = truth - belief.mean;
  if (belief.motion != PadMotion::kVelocity) error(3) = WrapAngle(error(3));
  PadMatrix cov = belief.cov;
  if (StateSize(belief.motion) == 4) {  // the fifth entry does not exist
    error(4) = 0.0;
    cov(4, 4) = 1.0;
  }
  return error.dot(cov.llt().solve(error));
}

double PositionNees(const PadState& pad, const Eigen::Vector2d& p_WP) {
  const Eigen::Vector2d error = p_WP - pad.p_WP.head<2>();
  return error.dot(pad.cov_p.inverse() * error);
}

}  // namespace touchdown::estimation
