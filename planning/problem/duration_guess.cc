// SPDX-License-Identifier: BSD-3-Clause
// Arrival time of a one-dimensional plateau profile in the pad's frame. The pad's velocity is its
// mean over the flight, so that a turning pad is followed by a few fixed-point steps on T.

#include "planning/problem/duration_guess.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchdown::planning {

namespace {

// Shares of the limits that the profile uses: a smooth spline cannot sit on its limits.
constexpr double kCruiseShare = 0.80;
constexpr double kFastCruiseShare = 0.97;
constexpr double kSlowestClosing = 0.02;
constexpr double kAccelerationShare = 0.45;
constexpr int kFixedPointSteps = 6;
constexpr double kZeroLength = 1e-3;  // [m]

/// Time to cover `length` from closing speed v0 to rest with plateau `cruise` and acceleration a.
double PlateauTime(double length, double v0, double cruise, double a) {
  const double top = std::max(cruise, v0);
  const double ramps = std::abs(top - v0) / a + top / a;
  const double ramp_length = (top + v0) / 2.0 * std::abs(top - v0) / a + top * top / (2.0 * a);
  if (ramp_length <= length) return ramps + (length - ramp_length) / top;
  // No plateau: a peak speed v with (v^2 - v0^2)/2a + v^2/2a = length. A start too fast for that
  // overshoots; then the time to stop counts.
  const double peak = std::sqrt(a * length + 0.5 * v0 * v0);
  return peak >= v0 ? (peak - v0) / a + peak / a : 2.0 * v0 / a;
}

/// The fixed point for one cruise share; +infinity if the end runs away from it.
double GuessAtShare(const SplineState& start, double t0, const estimation::PadPrediction& pad,
                    const EndpointTarget& target, const Limits& limits, double detour,
                    double share) noexcept {
  const double a = kAccelerationShare * limits.acceleration;
  const double speed = share * limits.speed;
  const SplineState goal_now = EndStateAt(pad, target, t0).state;
  const Eigen::Vector3d gap = goal_now.p - start.p;
  const double length = gap.norm() * detour;
  if (length < kZeroLength) return 0.0;
  const Eigen::Vector3d along = gap.normalized();
  double T = length / limits.speed;
  for (int i = 0; i < kFixedPointSteps; ++i) {
    const Eigen::Vector3d mean_velocity =
        T > 1e-3 ? Eigen::Vector3d((EndStateAt(pad, target, t0 + T).state.p - goal_now.p) / T)
                 : goal_now.v;
    const double with_us = mean_velocity.dot(along);
    const double across = (mean_velocity - with_us * along).norm();
    if (speed <= across) return std::numeric_limits<double>::infinity();
    const double cruise = std::sqrt(speed * speed - across * across) - with_us;
    if (cruise < kSlowestClosing * limits.speed) return std::numeric_limits<double>::infinity();
    const Eigen::Vector3d relative = start.v - mean_velocity;
    const double closing = relative.dot(along);
    const double sideways = (relative - closing * along).norm();
    // Flying away first costs the time to stop and the way back.
    const double away = std::max(0.0, -closing);
    T = PlateauTime(length + away * away / (2.0 * a), std::max(0.0, closing), cruise, a) +
        away / a + 0.5 * sideways / a;
  }
  return T;
}

}  // namespace

double GuessDuration(const SplineState& start, double t0, const estimation::PadPrediction& pad,
                     const EndpointTarget& target, const Limits& limits, double detour) noexcept {
  const double T = GuessAtShare(start, t0, pad, target, limits, detour, kCruiseShare);
  if (std::isfinite(T)) return T;
  // A fast pad leaves no reserve; the certificate decides whether it can be caught.
  return GuessAtShare(start, t0, pad, target, limits, detour, kFastCruiseShare);
}

}  // namespace touchdown::planning
