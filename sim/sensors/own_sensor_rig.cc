// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/own_sensor_rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/base/argument_check.h"
#include "sim/base/random_stream.h"

namespace touchdown::sim {
namespace {

constexpr double kLongSilence = 3.0;  // [s]

// The outage moved from the trial's time to the sensors' clock.
OwnSensorsConfig Shifted(const OwnSensorRigConfig& config) {
  OwnSensorsConfig sensors = config.sensors;
  sensors.gps.outage_begin += config.hover_before;
  return sensors;
}

}  // namespace

// The filter is told the truth about its sensors; a perfect one is taken as very good.
estimation::OwnStateOptions FilterOptionsFor(const OwnSensorRigConfig& config,
                                             const estimation::OwnStateOptions& given) {
  estimation::OwnStateOptions options = given;
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
  // Between two fixes of a slow sensor nothing is missing yet, but a long silence counts.
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

OwnSensorRig::OwnSensorRig(const OwnSensorRigConfig& config, std::uint64_t seed)
    : config_(config), seed_(seed), imu_(config.imu, seed), sensors_(Shifted(config), seed) {
  using estimation::CheckWithin;
  CheckWithin("own_state.hover_before", config.hover_before, 0.5, 600.0);
  CheckWithin("own_state.takeoff_position_sigma", config.takeoff_position_sigma, 0.0, 100.0);
  CheckWithin("own_state.takeoff_heading_sigma", config.takeoff_heading_sigma, 0.0, 3.0);
}

OwnSensorRig::Takeoff OwnSensorRig::DrawTakeoff(const estimation::VehicleState& start,
                                                double timestep) const {
  estimation::CheckWithin("own_state timestep", timestep, 1e-4, 0.01);
  RandomStream takeoff(seed_, "own take-off");
  const double sigma = config_.takeoff_position_sigma;
  const double x = takeoff.Normal(sigma);
  const double y = takeoff.Normal(sigma);
  const double z = takeoff.Normal(sigma);
  const double turn = takeoff.Normal(config_.takeoff_heading_sigma);
  Takeoff known;
  known.has_position = config_.sensors.gps.sensor.rate_hz <= 0.0;
  known.position = {0.0, start.p_WB + Eigen::Vector3d(x, y, z), sigma, sigma};
  known.has_heading = config_.sensors.heading.rate_hz <= 0.0;
  known.heading = {0.0, estimation::Yaw(start.q_WB) + turn, config_.takeoff_heading_sigma};
  known.steps = std::lround(config_.hover_before / timestep);
  return known;
}

}  // namespace touchdown::sim
