// SPDX-License-Identifier: BSD-3-Clause
// Scalar losses rho(u): they measure a term's inner map u. Each loss knows:
// - its first two derivatives;
// - the residual r(u) with r^2 = 2 rho, which least-squares backends want (unless rho can be negative);
// - the interval of u that it stands for if the term is made a hard constraint;
// - a nominal curvature: one number that stands for rho'' near a solution.
// All are plain values; none allocates.
#pragma once

#include <algorithm>
#include <limits>
#include <variant>

namespace touchdown::solvers {

/// rho and its derivatives at one u.
struct LossValue {
  double rho = 0.0;
  double drho = 0.0;
  double d2rho = 0.0;
};

/// r with r^2 = 2 rho, and dr/du.
struct LossResidual {
  double r = 0.0;
  double dr = 0.0;
};

/// A bound that is at least so large is none: people write 1e20 or 1e30 for it.
inline constexpr double kNoBound = 1e19;

/// Interval of u that a loss is zero on: the hard constraint it softens.
struct LossBounds {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
};

/// rho(u) = w u^2 / 2. The residual keeps the sign: r = sqrt(w) u.
class SquareLoss {
 public:
  static constexpr bool kQuadratic = true;

  /// Throws std::invalid_argument unless weight >= 0.
  explicit SquareLoss(double weight);

  LossValue Value(double u) const { return {0.5 * w_ * u * u, w_ * u, w_}; }
  LossResidual Residual(double u) const { return {root_w_ * u, root_w_}; }
  double NominalCurvature(double /*u*/) const { return w_; }
  LossBounds bounds() const { return {0.0, 0.0}; }

 private:
  double w_;
  double root_w_;
};

/// The C2 cubic-quadratic hinge of EGO-Planner (Zhou et al. 2020, eq. 5) on c = max(0, u):
/// rho = w c^3 for c <= s, rho = w (3 s c^2 - 3 s^2 c + s^3) beyond. It is nondecreasing and
/// convex, so that a convex inner map stays convex.
class HingeLoss {
 public:
  static constexpr bool kQuadratic = false;

  /// `width` is s, in the unit of u. Throws std::invalid_argument unless weight >= 0, width > 0.
  HingeLoss(double weight, double width);

  LossValue Value(double u) const;
  /// r = sqrt(2 rho); its derivative is 0 where the hinge is inactive.
  LossResidual Residual(double u) const;
  /// Curvature at a typical excess, a tenth of the width; zero more than a width inside the limit.
  double NominalCurvature(double u) const { return u > -s_ ? 0.6 * w_ * s_ : 0.0; }
  LossBounds bounds() const { return {-std::numeric_limits<double>::infinity(), 0.0}; }
  /// The same with `factor` times the weight.
  HingeLoss Scaled(double factor) const { return HingeLoss(factor * w_, s_); }

 private:
  double w_;
  double s_;
};

/// A hinge on either side of an interval: zero for lo <= u <= hi, HingeLoss of what is beyond. A
/// bound may be infinite, or kNoBound and more; lo = hi is an equality where the term is made hard.
class RangeLoss {
 public:
  static constexpr bool kQuadratic = false;

  /// Throws std::invalid_argument unless lo <= hi, neither of which may be NaN, and as HingeLoss
  /// does.
  RangeLoss(LossBounds bounds, double weight, double width);

  LossValue Value(double u) const;
  /// Negative below the interval.
  LossResidual Residual(double u) const;
  double NominalCurvature(double u) const {
    return std::max(hinge_.NominalCurvature(bounds_.lo - u),
                    hinge_.NominalCurvature(u - bounds_.hi));
  }
  LossBounds bounds() const { return bounds_; }

 private:
  LossBounds bounds_;
  HingeLoss hinge_;
};

/// rho(u) = w u: a cost that is its inner map. It may be negative, so it has no residual.
class LinearLoss {
 public:
  static constexpr bool kQuadratic = true;

  /// Throws std::invalid_argument unless weight is finite.
  explicit LinearLoss(double weight);

  LossValue Value(double u) const { return {w_ * u, w_, 0.0}; }
  double NominalCurvature(double /*u*/) const { return 0.0; }
  LossBounds bounds() const { return {}; }

 private:
  double w_;
};

/// Any of them, where it is chosen at run time.
using AnyLoss = std::variant<SquareLoss, HingeLoss, RangeLoss, LinearLoss>;

}  // namespace touchdown::solvers
