// SPDX-License-Identifier: BSD-3-Clause
// A path in arc length, s, and the way driven along it over time, s(t). With the curvature k and its
// slope k' by s, the direction d of the path and the normal n to its left:
//   v = s. d,  a = s.. d + s.^2 k n,  j = (s... - s.^3 k^2) d + (s.^3 k' + 3 s. s.. k) n.

#include "touchdown/sim/pad_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "touchdown/sim/argument_check.h"
#include "touchdown/sim/path_drive.h"

namespace touchdown::sim {
namespace {

using Kind = PadMotionConfig::Kind;

constexpr double kFar = 1.0e5;  // [m]
// A random drive is drawn for so long after its phase [s]: more than a trial and what it looks ahead.
constexpr double kRandomHorizon = 700.0;
constexpr double kLongestStretch = 600.0;   // of driving or standing [s]
constexpr double kMostAcceleration = 20.0;  // [m/s^2]
constexpr double kLongestPhase = 1.0e4;     // of one [s]: its drive is held in memory

bool Turns(Kind kind) {
  return kind == Kind::kCircle || kind == Kind::kStraightTurn || kind == Kind::kFigureEight ||
         kind == Kind::kRandom;
}

bool ChangesSpeed(Kind kind) {
  return kind == Kind::kStopAndGo || kind == Kind::kReversing || kind == Kind::kRandom ||
         kind == Kind::kWaypoints;
}

void ValidatePace(const PadMotionConfig& config) {
  CheckWithin("pad.acceleration", config.acceleration, 0.05, kMostAcceleration);
  CheckWithin("pad.jerk", config.jerk, 0.05, 100.0);
  const bool reverses = config.kind == Kind::kReversing, stops = config.kind == Kind::kStopAndGo;
  if (reverses || stops) {
    // A change of speed takes three times the smoothing, and must be over before the next one.
    const double range = (reverses ? 2.0 : 1.0) * config.speed;
    const double change = 3.0 * Pace::SmoothingFor(range, config.acceleration, INFINITY);
    if (change > kLongestStretch) {
      const double least = config.acceleration * change / kLongestStretch;
      CheckWithin("pad.acceleration", config.acceleration, least, kMostAcceleration);
    }
    CheckWithin("pad.go_time", config.go_time, change, kLongestStretch);
    if (stops) CheckWithin("pad.stop_time", config.stop_time, change, kLongestStretch);
  }
  if (config.kind == Kind::kRandom) {
    CheckWithin("pad.phase", config.phase, -kFar, std::min(kFar, kLongestPhase * config.speed));
  }
  if (config.kind == Kind::kWaypoints) CheckWithin("pad.phase", config.phase, 0.0, 0.0);
}

void ValidateConfig(const PadMotionConfig& config) {
  for (int axis = 0; axis < 3; ++axis) {
    CheckWithin(std::string("pad.p_start.") + "xyz"[axis], config.p_start[axis], -kFar, kFar);
  }
  CheckWithin("pad.heading", config.heading, -100.0, 100.0);
  CheckWithin("pad.phase", config.phase, -kFar, kFar);
  CheckWithin("pad.speed", config.speed, 0.0, 20.0);
  if (Turns(config.kind) || ChangesSpeed(config.kind)) {
    CheckWithin("pad.speed", config.speed, 0.01, 20.0);
  }
  if (config.kind == Kind::kCircle || config.kind == Kind::kFigureEight) {
    CheckWithin("pad.turn_rate", std::abs(config.turn_rate), 1.0e-4, 5.0);
  }
  if (config.kind == Kind::kRandom) CheckWithin("pad.turn_rate", config.turn_rate, 1.0e-4, 5.0);
  if (ChangesSpeed(config.kind)) ValidatePace(config);
  if (config.kind == Kind::kStraightTurn) {
    CheckWithin("pad.turn_rate", config.turn_rate, 1.0e-4, 5.0);
    CheckWithin("pad.turn_start", config.turn_start, 0.0, kFar);
    CheckWithin("pad.turn_ramp_s", config.turn_ramp_s, 0.01, 10.0);
    // Building the yaw rate up and down again turns by turn_rate * turn_ramp_s already.
    CheckWithin("magnitude of pad.turn_angle", std::abs(config.turn_angle),
                config.turn_rate * config.turn_ramp_s, 2.0 * std::numbers::pi);
  }
}

CurvatureChain ChainOf(const PadMotionConfig& config) {
  CurvatureChain chain(config.p_start.head<2>(), config.heading);
  if (config.kind == Kind::kCircle) {
    const double curvature = config.turn_rate / config.speed;
    chain.Append(0.0, curvature, curvature);
  } else if (config.kind == Kind::kStraightTurn) {
    const double curvature = std::copysign(config.turn_rate / config.speed, config.turn_angle);
    const double ramp = config.speed * config.turn_ramp_s;
    chain.Append(config.turn_start, 0.0, 0.0);
    chain.Append(ramp, 0.0, curvature);
    chain.Append(config.turn_angle / curvature - ramp, curvature, curvature);
    chain.Append(ramp, curvature, 0.0);
    chain.Append(0.0, 0.0, 0.0);
  } else {
    chain.Append(0.0, 0.0, 0.0);
  }
  return chain;
}

}  // namespace

PadMotion::PadMotion(const PadMotionConfig& config)
    : config_(config), path_(CurvatureChain(Eigen::Vector2d::Zero(), 0.0)) {
  ValidateConfig(config);
  const Eigen::Vector2d start = config.p_start.head<2>();
  if (config.kind == Kind::kFigureEight) {
    path_ = FigureEight(start, config.heading, config.turn_rate / config.speed);
  } else if (config.kind == Kind::kRandom) {
    PathDrive drive = RandomDrive(
        start, config.heading, {config.speed, config.turn_rate, config.acceleration, config.jerk},
        config.seed, std::max(0.0, config.phase / config.speed) + kRandomHorizon);
    path_ = std::move(drive.path);
    pace_ = std::move(drive.pace);
  } else if (config.kind == Kind::kWaypoints) {
    PathDrive drive = WaypointDrive(config.waypoints, config.acceleration, config.jerk);
    path_ = std::move(drive.path);
    pace_ = std::move(drive.pace);
  } else {
    path_ = ChainOf(config);
  }
  if (config.kind == Kind::kStopAndGo) {
    pace_ = StopAndGoPace(config.speed, config.go_time, config.stop_time, config.acceleration);
  } else if (config.kind == Kind::kReversing) {
    pace_ = ReversingPace(config.speed, config.go_time, config.acceleration);
  }
}

PathPoint PadMotion::PathAt(double s) const noexcept {
  if (const auto* chain = std::get_if<CurvatureChain>(&path_)) return chain->At(s);
  return std::get_if<FigureEight>(&path_)->At(s);
}

PacePoint PadMotion::PaceAt(double t) const noexcept {
  if (config_.kind == Kind::kStatic) return {};
  if (!pace_) return {config_.speed * t + config_.phase, config_.speed, 0.0, 0.0};
  return pace_->At(config_.phase == 0.0 ? t : t + config_.phase / config_.speed);
}

PadMotionBounds PadMotion::bounds() const {
  PadMotionBounds bounds;
  if (config_.kind == Kind::kStatic) return bounds;
  const PathBounds path = std::visit([](const auto& p) { return p.bounds(); }, path_);
  const double v = pace_ ? std::max(std::abs(pace_->LeastSpeed()), std::abs(pace_->GreatestSpeed()))
                         : config_.speed;
  const double along = pace_ ? pace_->MaxAcceleration() : 0.0;
  bounds.speed = v;
  bounds.acceleration = std::hypot(along, v * v * path.curvature);
  bounds.yaw_acceleration = v * v * path.curvature_slope + along * path.curvature;
  return bounds;
}

estimation::PadState PadMotion::At(double t) const noexcept {
  const PacePoint pace = PaceAt(t);
  const PathPoint point = PathAt(pace.s);
  const double v = pace.speed;
  const Eigen::Vector2d along(std::cos(point.yaw), std::sin(point.yaw));
  const Eigen::Vector2d left(-along.y(), along.x());
  estimation::PadState pad;
  pad.p_WP << point.p, config_.p_start.z();
  pad.v_WP.head<2>() = v * along;
  pad.a_WP.head<2>() = v * v * point.curvature * left + pace.acceleration * along;
  pad.j_WP.head<2>() =
      v * v * v * (point.curvature_slope * left - point.curvature * point.curvature * along) +
      (pace.jerk * along + 3.0 * v * pace.acceleration * point.curvature * left);
  pad.yaw = point.yaw;
  pad.yaw_rate = v * point.curvature;
  return pad;
}

}  // namespace touchdown::sim
