// SPDX-License-Identifier: BSD-3-Clause
// From the numbers of a motion to its path and pace.

#include "sim/pad/pad_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimation/base/argument_check.h"
#include "sim/pad/path_drive.h"

namespace touchdown::sim {
namespace {

using Kind = PadMotionConfig::Kind;

constexpr double kFar = 1.0e5;  // [m]
// A random drive is drawn for so long after its phase [s]: more than a trial and its horizon.
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
  estimation::CheckWithin("pad.acceleration", config.acceleration, 0.05, kMostAcceleration);
  estimation::CheckWithin("pad.jerk", config.jerk, 0.05, 100.0);
  const bool reverses = config.kind == Kind::kReversing, stops = config.kind == Kind::kStopAndGo;
  if (reverses || stops) {
    // A change of speed takes three times the smoothing, and must be over before the next one.
    const double range = (reverses ? 2.0 : 1.0) * config.speed;
    const double change = 3.0 * Pace::SmoothingFor(range, config.acceleration, INFINITY);
    if (change > kLongestStretch) {
      const double least = config.acceleration * change / kLongestStretch;
      estimation::CheckWithin("pad.acceleration", config.acceleration, least, kMostAcceleration);
    }
    estimation::CheckWithin("pad.go_time", config.go_time, change, kLongestStretch);
    if (stops) estimation::CheckWithin("pad.stop_time", config.stop_time, change, kLongestStretch);
  }
  if (config.kind == Kind::kRandom) {
    estimation::CheckWithin("pad.phase", config.phase, -kFar,
                            std::min(kFar, kLongestPhase * config.speed));
  }
  if (config.kind == Kind::kWaypoints) estimation::CheckWithin("pad.phase", config.phase, 0.0, 0.0);
}

void ValidateConfig(const PadMotionConfig& config) {
  for (int axis = 0; axis < 3; ++axis) {
    estimation::CheckWithin(std::string("pad.p_start.") + "xyz"[axis], config.p_start[axis], -kFar,
                            kFar);
  }
  estimation::CheckWithin("pad.heading", config.heading, -100.0, 100.0);
  estimation::CheckWithin("pad.phase", config.phase, -kFar, kFar);
  estimation::CheckWithin("pad.speed", config.speed, 0.0, 20.0);
  if (Turns(config.kind) || ChangesSpeed(config.kind)) {
    estimation::CheckWithin("pad.speed", config.speed, 0.01, 20.0);
  }
  if (config.kind == Kind::kCircle || config.kind == Kind::kFigureEight) {
    estimation::CheckWithin("pad.turn_rate", std::abs(config.turn_rate), 1.0e-4, 5.0);
  }
  if (config.kind == Kind::kRandom)
    estimation::CheckWithin("pad.turn_rate", config.turn_rate, 1.0e-4, 5.0);
  if (ChangesSpeed(config.kind)) ValidatePace(config);
  if (config.kind == Kind::kStraightTurn) {
    estimation::CheckWithin("pad.turn_rate", config.turn_rate, 1.0e-4, 5.0);
    estimation::CheckWithin("pad.turn_start", config.turn_start, 0.0, kFar);
    estimation::CheckWithin("pad.turn_ramp_s", config.turn_ramp_s, 0.01, 10.0);
    // Building the yaw rate up and down again turns by turn_rate * turn_ramp_s already.
    estimation::CheckWithin("magnitude of pad.turn_angle", std::abs(config.turn_angle),
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

PathCourse CourseOf(const PadMotionConfig& config) {
  ValidateConfig(config);
  const Eigen::Vector2d start = config.p_start.head<2>();
  const double height = config.p_start.z();
  const auto driven = [&](PathCourse::Path path, Pace pace) -> PathCourse {
    const double t_phase = config.phase == 0.0 ? 0.0 : config.phase / config.speed;
    return {std::move(path), height, std::move(pace), t_phase};
  };
  switch (config.kind) {
    case Kind::kStatic:
      return {ChainOf(config), height, 0.0, 0.0};
    case Kind::kStraightTurn:
    case Kind::kCircle:
    case Kind::kLine:
      return {ChainOf(config), height, config.speed, config.phase};
    case Kind::kFigureEight:
      return {FigureEight(start, config.heading, config.turn_rate / config.speed), height,
              config.speed, config.phase};
    case Kind::kStopAndGo:
      return driven(ChainOf(config), StopAndGoPace(config.speed, config.go_time, config.stop_time,
                                                   config.acceleration));
    case Kind::kReversing:
      return driven(ChainOf(config),
                    ReversingPace(config.speed, config.go_time, config.acceleration));
    case Kind::kRandom: {
      PathDrive drive = RandomDrive(
          start, config.heading, {config.speed, config.turn_rate, config.acceleration, config.jerk},
          config.seed, std::max(0.0, config.phase / config.speed) + kRandomHorizon);
      return driven(std::move(drive.path), std::move(drive.pace));
    }
    case Kind::kWaypoints: {
      PathDrive drive = WaypointDrive(config.waypoints, config.acceleration, config.jerk);
      return driven(std::move(drive.path), std::move(drive.pace));
    }
  }
  throw std::invalid_argument("pad.motion: there is no such motion");
}

}  // namespace

PadMotion::PadMotion(const PadMotionConfig& config) : PathCourse(CourseOf(config)) {}

}  // namespace touchdown::sim
