// SPDX-License-Identifier: BSD-3-Clause
// Square, cubic-quadratic hinge, two-sided and linear losses. The hinge is the collision penalty of
// X. Zhou et al., "EGO-Planner: An ESDF-free gradient-based local planner for quadrotors", RA-L
// 2020, eq. 5.

#include "touchdown/solvers/problem/loss.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace touchdown::solvers {

SquareLoss::SquareLoss(double weight) : w_(weight), root_w_(std::sqrt(weight)) {
  if (!(weight >= 0.0)) {
    throw std::invalid_argument("SquareLoss: weight is " + std::to_string(weight) +
                                ", it must be >= 0");
  }
}

HingeLoss::HingeLoss(double weight, double width) : w_(weight), s_(width) {
  if (!(weight >= 0.0)) {
    throw std::invalid_argument("HingeLoss: weight is " + std::to_string(weight) +
                                ", it must be >= 0");
  }
  if (!(width > 0.0)) {
    throw std::invalid_argument("HingeLoss: width is " + std::to_string(width) +
                                ", it must be > 0");
  }
}

LossValue HingeLoss::Value(double u) const {
  if (std::isnan(u)) return {u, u, u};
  if (u <= 0.0) return {};
  if (u <= s_) return {w_ * u * u * u, 3.0 * w_ * u * u, 6.0 * w_ * u};
  return {w_ * (3.0 * s_ * u * u - 3.0 * s_ * s_ * u + s_ * s_ * s_),
          w_ * (6.0 * s_ * u - 3.0 * s_ * s_), 6.0 * w_ * s_};
}

LossResidual HingeLoss::Residual(double u) const {
  const LossValue value = Value(u);
  if (value.rho == 0.0) return {};
  const double r = std::sqrt(2.0 * value.rho);
  return {r, value.drho / r};
}

RangeLoss::RangeLoss(LossBounds bounds, double weight, double width)
    : bounds_(bounds), hinge_(weight, width) {
  if (!(bounds.lo <= bounds.hi)) {
    throw std::invalid_argument("RangeLoss: bounds are [" + std::to_string(bounds.lo) + ", " +
                                std::to_string(bounds.hi) + "], they must satisfy lo <= hi");
  }
  if (bounds.lo <= -kNoBound) bounds_.lo = -std::numeric_limits<double>::infinity();
  if (bounds.hi >= kNoBound) bounds_.hi = std::numeric_limits<double>::infinity();
}

LossValue RangeLoss::Value(double u) const {
  if (!(u < bounds_.lo)) return hinge_.Value(u - bounds_.hi);
  const LossValue below = hinge_.Value(bounds_.lo - u);
  return {below.rho, -below.drho, below.d2rho};
}

LossResidual RangeLoss::Residual(double u) const {
  if (!(u < bounds_.lo)) return hinge_.Residual(u - bounds_.hi);
  const LossResidual below = hinge_.Residual(bounds_.lo - u);
  return {-below.r, below.dr};
}

LinearLoss::LinearLoss(double weight) : w_(weight) {
  if (!std::isfinite(weight)) {
    throw std::invalid_argument("LinearLoss: weight is " + std::to_string(weight) +
                                ", it must be finite");
  }
}

}  // namespace touchdown::solvers
