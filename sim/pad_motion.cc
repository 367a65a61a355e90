// SPDX-License-Identifier: BSD-3-Clause
// The path is a chain of segments in arc length s = speed * t + phase. Within one the curvature
// goes from k0 to k1 along the smooth step 3u^2 - 2u^3 of u = s / length, so that curvature and its
// slope, hence acceleration and jerk, are continuous over the chain. The heading is its integral in
// closed form; the position is closed form on straights and arcs and Gauss-Legendre quadrature on
// the short ramps, to rounding. The first segment is continued backwards and the last forwards
// without end.

#include "touchdown/sim/pad_motion.h"

#include <cmath>
#include <numbers>

#include "touchdown/sim/argument_check.h"

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

void ValidateConfig(const PadMotionConfig& config) {
  using Kind = PadMotionConfig::Kind;
  constexpr double kFar = 1.0e5;  // [m]
  for (int axis = 0; axis < 3; ++axis) {
    CheckWithin(std::string("pad.p_start.") + "xyz"[axis], config.p_start[axis], -kFar, kFar);
  }
  CheckWithin("pad.heading", config.heading, -100.0, 100.0);
  CheckWithin("pad.phase", config.phase, -kFar, kFar);
  CheckWithin("pad.speed", config.speed, 0.0, 20.0);
  if (config.kind == Kind::kCircle || config.kind == Kind::kStraightTurn) {
    CheckWithin("pad.speed", config.speed, 0.01, 20.0);
  }
  if (config.kind == Kind::kCircle) {
    CheckWithin("pad.turn_rate", std::abs(config.turn_rate), 1.0e-4, 5.0);
  }
  if (config.kind == Kind::kStraightTurn) {
    CheckWithin("pad.turn_rate", config.turn_rate, 1.0e-4, 5.0);
    CheckWithin("pad.turn_start", config.turn_start, 0.0, kFar);
    CheckWithin("pad.turn_ramp_s", config.turn_ramp_s, 0.01, 10.0);
    // Building the yaw rate up and down again turns by turn_rate * turn_ramp_s already.
    CheckWithin("magnitude of pad.turn_angle", std::abs(config.turn_angle),
                config.turn_rate * config.turn_ramp_s, 2.0 * std::numbers::pi);
  }
}

}  // namespace

PadMotion::PadMotion(const PadMotionConfig& config) : config_(config) {
  using Kind = PadMotionConfig::Kind;
  ValidateConfig(config);
  switch (config.kind) {
    case Kind::kStatic:
    case Kind::kLine:
      Append(0.0, 0.0, 0.0);
      break;
    case Kind::kCircle: {
      const double curvature = config.turn_rate / config.speed;
      Append(0.0, curvature, curvature);
      break;
    }
    case Kind::kStraightTurn: {
      const double curvature = std::copysign(config.turn_rate / config.speed, config.turn_angle);
      const double ramp = config.speed * config.turn_ramp_s;
      Append(config.turn_start, 0.0, 0.0);
      Append(ramp, 0.0, curvature);
      Append(config.turn_angle / curvature - ramp, curvature, curvature);
      Append(ramp, curvature, 0.0);
      Append(0.0, 0.0, 0.0);
      break;
    }
  }
}

void PadMotion::Append(double length, double k0, double k1) {
  Segment next{0.0, length, k0, k1, config_.p_start.head<2>(), config_.heading};
  if (count_ > 0) {
    const Segment& last = segments_[count_ - 1];
    next.s0 = last.s0 + last.length;
    const PathPoint end = PointOn(last, last.length);
    next.p0 = end.p;
    next.yaw0 = end.yaw;
  }
  segments_[count_++] = next;
}

PadMotion::PathPoint PadMotion::PointOn(const Segment& segment, double s) noexcept {
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

estimation::PadState PadMotion::At(double t) const noexcept {
  const double speed = config_.kind == PadMotionConfig::Kind::kStatic ? 0.0 : config_.speed;
  const double s = config_.kind == PadMotionConfig::Kind::kStatic ? 0.0 : speed * t + config_.phase;
  std::size_t i = 0;
  while (i + 1 < count_ && s >= segments_[i + 1].s0) ++i;
  const PathPoint point = PointOn(segments_[i], s - segments_[i].s0);

  const Eigen::Vector2d along(std::cos(point.yaw), std::sin(point.yaw));
  const Eigen::Vector2d left(-along.y(), along.x());
  estimation::PadState pad;
  pad.p_WP << point.p, config_.p_start.z();
  pad.v_WP.head<2>() = speed * along;
  pad.a_WP.head<2>() = speed * speed * point.curvature * left;
  pad.j_WP.head<2>() = speed * speed * speed *
                       (point.curvature_slope * left - point.curvature * point.curvature * along);
  pad.yaw = point.yaw;
  pad.yaw_rate = speed * point.curvature;
  return pad;
}

}  // namespace touchdown::sim
