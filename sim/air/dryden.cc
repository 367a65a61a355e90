// SPDX-License-Identifier: BSD-3-Clause
// Dryden turbulence: US Military Specification MIL-F-8785C (1980), section 3.7.2 and the
// low-altitude model of 3.7.3.4. With h in feet:
//   L_w = h,  L_u = L_v = h / (0.177 + 0.000823 h)^1.2,  sigma_w / sigma_u = (0.177 + 0.000823 h)^0.4.
// With tau = L / V, the shaping filters are
//   H_u = sigma_u sqrt(2 tau) / (1 + tau s),
//   H_v = sigma_v sqrt(tau) (1 + sqrt(3) tau s) / (1 + tau s)^2, and H_w likewise,
// driven by white noise of unit intensity.
//
// They are discretised exactly. In the dimensionless time s = t / tau the second-order filter does not depend on tau:
//   x1' = -x1 + n,  x2' = x1 - x2,  y = sqrt(3) x1 + (1 - sqrt(3)) x2.
// Its stationary covariance is P = [1/2 1/4; 1/4 1/4], and y has variance 1. Over d = dt/tau the state goes through F =
// e^-d [1 0; d 1] and gains noise of covariance P - F P F^T. With p(n) = 1 - e^-2d sum_{k<n} (2d)^k / k! this is
// [p(1)/2 p(2)/4; p(2)/4 p(3)/4]. p is summed from its upper end, where nothing cancels even for a small d. So variance
// and spectrum are right for every step length, and stay so while V and h change.

#include "sim/air/dryden.h"

#include <algorithm>
#include <cmath>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

constexpr double kFoot = 0.3048;  // [m]
constexpr double kLowest = 10.0;  // [ft]
constexpr double kHighest = 1000.0;
constexpr double kRoot3 = 1.73205080756887729;

// Probability that a Poisson variable of mean x is n or more.
double UpperPoisson(int n, double x) {
  double term = std::exp(-x);
  for (int k = 1; k <= n; ++k) term *= x / k;
  double sum = 0.0;
  for (int k = n; term > 1e-18 * sum || k < n + x; ++k) {
    sum += term;
    term *= x / (k + 1);
  }
  return std::min(sum, 1.0);
}

// One step of the second-order filter over d = dt / tau; its output.
double StepFilter(double d, Eigen::Vector2d* x, RandomStream* noise) {
  d = std::min(d, 50.0);  // nothing is left of the state long before
  const double q11 = 0.5 * UpperPoisson(1, 2.0 * d);
  const double q21 = 0.25 * UpperPoisson(2, 2.0 * d);
  const double q22 = 0.25 * UpperPoisson(3, 2.0 * d);
  const double l11 = std::sqrt(q11);
  const double l21 = q21 / l11;
  const double l22 = std::sqrt(std::max(0.0, q22 - l21 * l21));
  const double n1 = noise->Normal(1.0);
  const double n2 = noise->Normal(1.0);
  const double decay = std::exp(-d);
  *x = {decay * x->x() + l11 * n1, decay * (d * x->x() + x->y()) + l21 * n1 + l22 * n2};
  return kRoot3 * x->x() + (1.0 - kRoot3) * x->y();
}

}  // namespace

DrydenScales DrydenScalesAt(double height) {
  const double h = std::clamp(height / kFoot, kLowest, kHighest);  // [ft]
  const double base = 0.177 + 0.000823 * h;
  return {h / std::pow(base, 1.2) * kFoot, h * kFoot, std::pow(base, 0.4)};
}

DrydenTurbulence::DrydenTurbulence(std::uint64_t seed) : noise_(seed, "turbulence") {
  along_ = noise_.Normal(1.0);
  // The lower triangle of P's Cholesky factor: sqrt(1/2), and (1/4) / sqrt(1/2) twice.
  for (Eigen::Vector2d* x : {&left_, &up_}) {
    const double n1 = noise_.Normal(1.0);
    const double n2 = noise_.Normal(1.0);
    *x = std::sqrt(0.5) * Eigen::Vector2d(n1, 0.5 * (n1 + n2));
  }
}

Eigen::Vector3d DrydenTurbulence::Step(double dt, double airspeed, double height) {
  estimation::CheckAbove("turbulence: time step [s]", dt, 0.0, 1e6);
  estimation::CheckAbove("turbulence: airspeed [m/s]", airspeed, 0.0, 1e6);
  const DrydenScales scales = DrydenScalesAt(height);
  const double d = dt * airspeed / scales.along;
  along_ = std::exp(-d) * along_ + std::sqrt(-std::expm1(-2.0 * d)) * noise_.Normal(1.0);
  const double left = StepFilter(d, &left_, &noise_);
  const double up = StepFilter(dt * airspeed / scales.up, &up_, &noise_);
  return {along_, left, scales.vertical_ratio * up};
}

}  // namespace touchdown::sim
