// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/own_estimate.h"

#include <cmath>
#include <numbers>

#include "estimation/base/covariance.h"

namespace touchdown::evaluation {

sim::OwnStateSourceConfig OwnSourceConfig(const Scenario& scenario) {
  const Scenario::Own& own = scenario.own;
  sim::OwnStateSourceConfig config;
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
  config.sensors.heading.sigma = own.heading.sigma_deg * std::numbers::pi / 180.0;
  return config;
}

OwnEstimate::OwnEstimate(const Scenario& scenario, const estimation::VehicleState& start,
                         double timestep, std::uint64_t seed)
    : now_(start) {
  if (scenario.own_state == OwnStateKind::kTrue) return;
  source_.emplace(OwnSourceConfig(scenario), seed, start, timestep);
  now_ = source_->estimate();
}

void OwnEstimate::Sense(const estimation::VehicleState& truth) {
  if (!source_) {
    now_ = truth;
  } else if (truth.t > now_.t) {  // the hover before the flight has told about t = 0
    now_ = source_->Step(truth);
  }
}

estimation::VehicleState OwnEstimate::At(const estimation::VehicleState& truth) const {
  return source_ ? source_->EstimateAt(truth.t) : truth;
}

estimation::OwnStatus OwnEstimate::status() const {
  return source_ ? source_->status() : estimation::OwnStatus::kGood;
}

double OwnEstimate::HorizontalSigma() const {
  if (!source_) return 0.0;
  return std::sqrt(
      estimation::LargestVariance(source_->filter().belief().cov.topLeftCorner<2, 2>()));
}

double OwnEstimate::PositionSigma() const { return LargestSigma(estimation::kPositionError); }
double OwnEstimate::AttitudeSigma() const { return LargestSigma(estimation::kAttitudeError); }

double OwnEstimate::LargestSigma(int first) const {
  if (!source_) return 0.0;
  return std::sqrt(source_->filter().belief().cov.diagonal().segment<3>(first).maxCoeff());
}

}  // namespace touchdown::evaluation
