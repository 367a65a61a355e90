// SPDX-License-Identifier: BSD-3-Clause
// Within a segment the heading is the integral of the curvature in closed form. The position is in
// closed form on straights and arcs. On ramps it is a Gauss-Legendre quadrature, exact to rounding.

#include "touchdown/sim/pad/curvature_chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace touchdown::sim {
namespace {

double SmoothStep(double u) { return u * u * (3.0 - 2.0 * u); }
double SmoothStepSlope(double u) { return 6.0 * u * (1.0 - u); }
double SmoothStepIntegral(double u) { return u * u * u * (1.0 - 0.5 * u); }

// Integral over [0, s] of the unit vector with heading yaw(x).
template <typename Heading>
Eigen::Vector2d IntegrateDirection(const Heading& yaw, double s) {
  // Gauss-Legendre nodes and weights of order 8 on [-1, 1] (Abramowitz and Stegun, table 25.4).
  constexpr std::array<double, 4> kNodes = {0.18343464249564980494, 0.52553240991632898582,
                                            0.79666647741362673959, 0.96028985649753623168};
  constexpr std::array<double, 4> kWeights = {0.36268378337836198297, 0.31370664587788728734,
                                              0.22238103445337447054, 0.10122853629037625915};
  // A ramp turns by half of the turn at most, so two panels keep the rule at rounding error.
  constexpr int kPanels = 2;
  const double half = 0.5 * s / kPanels;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int panel = 0; panel < kPanels; ++panel) {
    const double middle = (2 * panel + 1) * half;
    for (std::size_t i = 0; i < kNodes.size(); ++i) {
      for (const double x : {middle - half * kNodes[i], middle + half * kNodes[i]}) {
        sum += kWeights[i] * half * Eigen::Vector2d(std::cos(yaw(x)), std::sin(yaw(x)));
      }
    }
  }
  return sum;
}

}  // namespace

void CurvatureChain::Append(double length, double k0, double k1) {
  if (!(length >= 0.0) || !std::isfinite(length) || !std::isfinite(k0) || !std::isfinite(k1)) {
    throw std::invalid_argument("CurvatureChain: a stretch of " + std::to_string(length) +
                                " m from curvature " + std::to_string(k0) + " to " +
                                std::to_string(k1) + " 1/m; it must be >= 0 m, and all finite");
  }
  Segment next{0.0, length, k0, k1, start_, heading_};
  if (!segments_.empty()) {
    const Segment& last = segments_.back();
    next.s0 = last.s0 + last.length;
    const PathPoint end = PointOn(last, last.length);
    next.p0 = end.p;
    next.yaw0 = end.yaw;
  }
  segments_.push_back(next);
}

PathPoint CurvatureChain::PointOn(const Segment& segment, double s) noexcept {
  PathPoint point;
  if (segment.k0 != segment.k1) {
    const double step = segment.k1 - segment.k0;
    const auto yaw = [&](double x) {
      return segment.yaw0 + segment.k0 * x +
             step * segment.length * SmoothStepIntegral(x / segment.length);
    };
    const double u = s / segment.length;
    point.yaw = yaw(s);
    point.curvature = segment.k0 + step * SmoothStep(u);
    point.curvature_slope = step * SmoothStepSlope(u) / segment.length;
    point.p = segment.p0 + IntegrateDirection(yaw, s);
    return point;
  }
  point.curvature = segment.k0;
  point.yaw = segment.yaw0 + segment.k0 * s;
  // Chord of an arc: length s sinc(k s / 2) along the mean heading.
  const double half_turn = 0.5 * segment.k0 * s;
  const double chord = half_turn == 0.0 ? s : s * std::sin(half_turn) / half_turn;
  const double mean_yaw = segment.yaw0 + half_turn;
  point.p = segment.p0 + chord * Eigen::Vector2d(std::cos(mean_yaw), std::sin(mean_yaw));
  return point;
}

PathPoint CurvatureChain::At(double s) const noexcept {
  const auto after = std::upper_bound(segments_.begin() + 1, segments_.end(), s,
                                      [](double at, const Segment& x) { return at < x.s0; });
  const Segment& segment = *(after - 1);
  return PointOn(segment, s - segment.s0);
}

double CurvatureChain::length() const { return segments_.back().s0 + segments_.back().length; }

PathBounds CurvatureChain::bounds() const {
  PathBounds bounds;
  for (const Segment& segment : segments_) {
    bounds.curvature = std::max({bounds.curvature, std::abs(segment.k0), std::abs(segment.k1)});
    if (segment.k0 == segment.k1) continue;
    const double slope = kSteepestStep * std::abs(segment.k1 - segment.k0) / segment.length;
    bounds.curvature_slope = std::max(bounds.curvature_slope, slope);
  }
  return bounds;
}

}  // namespace touchdown::sim
