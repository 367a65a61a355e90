// SPDX-License-Identifier: BSD-3-Clause
// The air's velocity at the vehicle's position. The turbulence field is frozen and blows past the vehicle (Taylor's
// hypothesis), so the airspeed sets the spectrum in time. For a hovering vehicle the airspeed is the wind's; it is
// never taken below 1 m/s, where the hypothesis ends. Gusts have the shape (1 - cos)/2 of the discrete gust of
// MIL-F-8785C, 3.7.1.3, and of CS-25.341, from rise to fall.

#include "sim/air/wind.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

constexpr double kLeastAirspeed = 1.0;  // [m/s]
constexpr double kLongest = 1e6;        // [s]

const WindConfig& Checked(const WindConfig& config) {
  estimation::CheckWithin("wind.mean", config.mean, 0.0, 30.0);
  estimation::CheckWithin("wind.max", config.max, config.mean, 40.0);
  estimation::CheckWithin("wind.direction", config.direction, -1e3, 1e3);
  estimation::CheckWithin("wind.gust.speed", config.gust.speed, 0.0, 30.0);
  estimation::CheckWithin("wind.gust.start", config.gust.start, 0.0, kLongest);
  estimation::CheckAbove("wind.gust.duration", config.gust.duration, 0.0, kLongest);
  if (config.gust.period != 0.0) {
    estimation::CheckWithin("wind.gust.period", config.gust.period, config.gust.duration, kLongest);
  }
  return config;
}

}  // namespace

Wind::Wind(const WindConfig& config, std::uint64_t seed)
    : config_(Checked(config)),
      along_(std::cos(config.direction), std::sin(config.direction), 0.0),
      left_(-along_.y(), along_.x(), 0.0),
      turbulence_(seed) {}

double Wind::GustAt(double t) const {
  const WindConfig::Gust& gust = config_.gust;
  double since = t - gust.start;
  if (since < 0.0) return 0.0;
  if (gust.period > 0.0) since = std::fmod(since, gust.period);
  if (since >= gust.duration) return 0.0;
  return 0.5 * gust.speed * (1.0 - std::cos(2.0 * std::numbers::pi * since / gust.duration));
}

Eigen::Vector3d Wind::Step(const estimation::VehicleState& vehicle, double dt) {
  Eigen::Vector3d air = config_.mean * along_;
  const double sigma = 0.5 * (config_.max - config_.mean);
  if (sigma > 0.0) {
    const double airspeed = std::max(kLeastAirspeed, (vehicle.v_WB - air).norm());
    const Eigen::Vector3d n = sigma * turbulence_.Step(dt, airspeed, vehicle.p_WB.z());
    air += n.x() * along_ + n.y() * left_ + n.z() * Eigen::Vector3d::UnitZ();
    const double speed = air.norm();
    if (speed > config_.max) air *= config_.max / speed;
  }
  return air + GustAt(vehicle.t) * along_;
}

}  // namespace touchdown::sim
