// SPDX-License-Identifier: BSD-3-Clause
// The sine-generated curve: its heading is A sin(phi), phi = 2 pi s / length. It closes on itself where the mean of
// cos(A sin(phi)), the Bessel function J0(A), is zero. A is the first zero, so the curve swings by 138 degrees to
// either side and crosses itself once a loop. Its position is the integral of the Jacobi-Anger series
//   cos(A sin phi) = J0(A) + 2 sum J_2k(A) cos(2k phi), sin(A sin phi) = 2 sum J_2k+1(A) sin((2k+1) phi)
// (Abramowitz and Stegun 9.1.42, 9.1.43). The terms fall below rounding after a dozen. Sine-generated curves: L.
// Leopold, W. Langbein, Sci. Am. 214 (1966) 60, for rivers.

#include "touchdown/sim/pad/figure_eight.h"

#include <cmath>
#include <numbers>
#include <version>
#ifndef __cpp_lib_math_special_functions  // the library of the browsers' compiler
#include <boost/math/special_functions/bessel.hpp>
#endif

namespace touchdown::sim {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kSwing = 2.404825557695772768621631879326;  // first zero of J0

double BesselJ(double order, double x) {
#ifdef __cpp_lib_math_special_functions
  return std::cyl_bessel_j(order, x);
#else
  return boost::math::cyl_bessel_j(order, x);
#endif
}

}  // namespace

FigureEight::FigureEight(const Eigen::Vector2d& start, double heading, double curvature)
    : start_(start),
      heading_(heading),
      length_(kTwoPi * kSwing / std::abs(curvature)),
      sense_(curvature > 0.0 ? 1.0 : -1.0) {
  const double scale = length_ / kTwoPi;
  for (int k = 0; k < kTerms; ++k) {
    const double even = 2.0 * (k + 1), odd = 2.0 * k + 1.0;
    along_[k] = scale * 2.0 * BesselJ(even, kSwing) / even;
    across_[k] = scale * 2.0 * BesselJ(odd, kSwing) / odd;
  }
}

PathPoint FigureEight::At(double s) const noexcept {
  const double phi = kTwoPi * std::remainder(s, length_) / length_;
  const double rate = kTwoPi / length_;
  Eigen::Vector2d q = Eigen::Vector2d::Zero();
  for (int k = 0; k < kTerms; ++k) {
    q.x() += along_[k] * std::sin(2.0 * (k + 1) * phi);
    q.y() += across_[k] * (1.0 - std::cos((2.0 * k + 1.0) * phi));
  }
  q.y() *= sense_;
  const double c = std::cos(heading_), s_h = std::sin(heading_);
  PathPoint point;
  point.p = start_ + Eigen::Vector2d(c * q.x() - s_h * q.y(), s_h * q.x() + c * q.y());
  point.yaw = heading_ + sense_ * kSwing * std::sin(phi);
  point.curvature = sense_ * kSwing * rate * std::cos(phi);
  point.curvature_slope = -sense_ * kSwing * rate * rate * std::sin(phi);
  return point;
}

PathBounds FigureEight::bounds() const {
  const double rate = kTwoPi / length_;
  return {kSwing * rate, kSwing * rate * rate};
}

}  // namespace touchdown::sim
