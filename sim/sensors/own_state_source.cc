// SPDX-License-Identifier: BSD-3-Clause
// Sensors and filter run on a clock that begins with the hover before the trial, so that no time is
// below zero; the trial's times are shifted on the way in and back on the way out. In the hover the
// vehicle is motionless at its start's pose. In each step the IMU comes first, then what has
// arrived of the other sensors in a fixed order.

#include "sim/sensors/own_state_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "sim/base/argument_check.h"
#include "sim/base/random_stream.h"

namespace touchdown::sim {
namespace {

constexpr double kLongSilence = 3.0;  // [s]

// The filter is told the truth about its sensors; a perfect one is taken as very good.
estimation::OwnStateOptions FilterOptions(const OwnStateSourceConfig& config) {
  estimation::OwnStateOptions options = config.filter;
  options.imu.accelerometer = std::max(config.imu.accelerometer_noise, 1e-5);
  options.imu.gyro = std::max(config.imu.gyro_noise, 1e-6);
  options.imu.accelerometer_walk = config.imu.accelerometer_walk;
  options.imu.gyro_walk = config.imu.gyro_walk;
  options.prior.accelerometer = std::max(config.imu.accelerometer_offset, 1e-4);
  options.prior.gyro = std::max(config.imu.gyro_offset, 1e-5);
  options.imu_rate_hz = config.imu.rate_hz;
  double latency = 0.0;
  for (const OwnSensorConfig* sensor : {&config.sensors.gps.sensor, &config.sensors.odometry,
                                        &config.sensors.height, &config.sensors.heading}) {
    latency = std::max(latency, 1e-3 * sensor->latency_ms);
  }
  options.max_delay = std::max(options.max_delay, latency + 0.1);
  // Between two fixes of a slow sensor nothing is missing yet; but a silence that is long is one.
  double period = std::numeric_limits<double>::infinity();
  for (const OwnSensorConfig* sensor : {&config.sensors.gps.sensor, &config.sensors.odometry}) {
    if (sensor->rate_hz <= 0.0) continue;
    period = std::min(period, 1.0 / sensor->rate_hz + 1e-3 * sensor->latency_ms);
  }
  if (std::isfinite(period)) {
    options.outage_after = std::max(options.outage_after, std::min(2.0 * period, kLongSilence));
  }
  return options;
}

// The outage moved from the trial's time to the sensors' clock.
OwnSensorsConfig Shifted(const OwnStateSourceConfig& config) {
  OwnSensorsConfig sensors = config.sensors;
  sensors.gps.outage_begin += config.hover_before;
  return sensors;
}

}  // namespace

OwnStateSource::OwnStateSource(const OwnStateSourceConfig& config, std::uint64_t seed,
                               const estimation::VehicleState& start, double timestep)
    : hover_before_(config.hover_before),
      imu_(config.imu, seed),
      sensors_(Shifted(config), seed),
      filter_(FilterOptions(config)) {
  CheckWithin("own_state.hover_before", config.hover_before, 0.5, 600.0);
  CheckWithin("own_state.takeoff_position_sigma", config.takeoff_position_sigma, 0.0, 100.0);
  CheckWithin("own_state.takeoff_heading_sigma", config.takeoff_heading_sigma, 0.0, 3.0);
  CheckWithin("own_state timestep", timestep, 1e-4, 0.01);
  estimation::VehicleState hover;
  hover.p_WB = start.p_WB;
  hover.q_WB = start.q_WB;
  RandomStream takeoff(seed, "own take-off");
  const double sigma = config.takeoff_position_sigma;
  const double x = takeoff.Normal(sigma);
  const double y = takeoff.Normal(sigma);
  const double z = takeoff.Normal(sigma);
  const double turn = takeoff.Normal(config.takeoff_heading_sigma);
  if (config.sensors.gps.sensor.rate_hz <= 0.0) {
    filter_.AddPosition({0.0, hover.p_WB + Eigen::Vector3d(x, y, z), sigma, sigma});
  }
  if (config.sensors.heading.rate_hz <= 0.0) {
    filter_.AddHeading({0.0, estimation::Yaw(hover.q_WB) + turn, config.takeoff_heading_sigma});
  }
  const long steps = std::lround(config.hover_before / timestep);
  for (long k = 0; k <= steps; ++k) {
    hover.t = static_cast<double>(k - steps) * timestep;
    Feed(hover);
  }
  if (!filter_.started()) {
    throw std::invalid_argument(
        "own_state.hover_before is " + NumberText(config.hover_before) +
        " s, too short for the filter to start; allowed is more than filter.hover_time, " +
        NumberText(config.filter.hover_time) + " s, and the sensors' latencies together");
  }
  estimate_ = filter_.Estimate(now_);
  estimate_.t = 0.0;
}

void OwnStateSource::Feed(const estimation::VehicleState& vehicle) {
  estimation::VehicleState shifted = vehicle;
  shifted.t = vehicle.t + hover_before_;
  now_ = shifted.t;
  if (const auto sample = imu_.Poll(shifted)) filter_.AddImu(*sample);
  sensors_.Sample(shifted);
  while (const auto fix = sensors_.PollPosition(now_)) filter_.AddPosition(*fix);
  while (const auto fix = sensors_.PollVelocity(now_)) filter_.AddVelocity(*fix);
  while (const auto sample = sensors_.PollHeight(now_)) filter_.AddHeight(*sample);
  while (const auto sample = sensors_.PollHeading(now_)) filter_.AddHeading(*sample);
}

estimation::VehicleState OwnStateSource::Step(const estimation::VehicleState& vehicle) {
  Feed(vehicle);
  estimate_ = filter_.Estimate(now_);
  estimate_.t = vehicle.t;
  return estimate_;
}

estimation::VehicleState OwnStateSource::EstimateAt(double t) const {
  estimation::VehicleState estimate = filter_.Estimate(t + hover_before_);
  estimate.t -= hover_before_;
  return estimate;
}

}  // namespace touchdown::sim
