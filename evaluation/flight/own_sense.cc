// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/own_sense.h"

#include "estimation/base/degrees.h"

namespace touchdown::evaluation {

sim::OwnSensorRigConfig OwnSensorsOf(const Scenario& scenario) {
  const Scenario::Own& own = scenario.own;
  sim::OwnSensorRigConfig config;
  for (double* noise :
       {&config.imu.accelerometer_noise, &config.imu.gyro_noise, &config.imu.accelerometer_walk,
        &config.imu.gyro_walk, &config.imu.accelerometer_offset, &config.imu.gyro_offset}) {
    *noise *= own.imu_noise;
  }
  sim::OwnGpsConfig& gps = config.sensors.gps;
  gps.sensor.rate_hz = own.gps.rate;
  gps.sensor.sigma = own.gps.sigma;
  gps.sensor.drift_sigma = own.gps.drift;
  gps.sensor.latency_ms = own.gps.latency_ms;
  gps.outage_begin = own.gps.outage[0];
  gps.outage_length = own.gps.outage[1] - own.gps.outage[0];
  config.sensors.odometry.rate_hz = own.odometry.rate;
  config.sensors.odometry.sigma = own.odometry.sigma;
  config.sensors.odometry.drift_sigma = own.odometry.drift;
  config.sensors.height.rate_hz = own.height.rate;
  config.sensors.height.sigma = own.height.sigma;
  config.sensors.heading.rate_hz = own.heading.rate;
  config.sensors.heading.sigma = estimation::Radians(own.heading.sigma_deg);
  return config;
}

OwnSense::OwnSense(const Scenario& scenario, std::uint64_t seed) {
  if (scenario.own_state == OwnStateKind::kEstimated) rig_.emplace(OwnSensorsOf(scenario), seed);
}

void OwnSense::Hover(const estimation::VehicleState& start, double timestep,
                     control::Onboard* onboard) {
  if (rig_) {
    rig_->Hover(start, timestep, [onboard](const auto& measured) { onboard->Take(measured); });
  } else {
    onboard->Take(start);
  }
}

void OwnSense::Sense(const estimation::VehicleState& truth, control::Onboard* onboard) {
  if (!rig_) {
    onboard->Take(truth);
  } else if (truth.t > 0.0) {  // the hover before the flight has told about t = 0
    rig_->Poll(truth, [onboard](const auto& measured) { onboard->Take(measured); });
  }
}

}  // namespace touchdown::evaluation
