// SPDX-License-Identifier: BSD-3-Clause
// True value plus white noise plus a stationary first-order Gauss-Markov error, sampled exactly:
//   d' = k d + sqrt(1 - k^2) sigma n with k = exp(-1 / (rate tau)).
// Odometry measures the velocity in the body frame, as visual-inertial odometry does without its
// drifting position and heading. Its white noise and drift, integrated, become the walk of its
// position.

#include "sim/sensors/own_sensors.h"

#include <cmath>
#include <numbers>
#include <string>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
OwnNoise::OwnNoise(const OwnSensorConfig& config, std::uint64_t seed, std::string_view name)
    : config_(config),
      white_(seed, name),
      drift_stream_(seed, std::string(name) + " drift"),
      drift_(Eigen::Vector3d::Zero()) {
  const std::string prefix(name);
  estimation::CheckWithin(prefix + ".rate_hz", config.rate_hz, 0.0, 1000.0);
  estimation::CheckWithin(prefix + ".sigma", config.sigma, 0.0, 100.0);
  estimation::CheckWithin(prefix + ".drift_sigma", config.drift_sigma, 0.0, 100.0);
  estimation::CheckWithin(prefix + ".drift_time", config.drift_time, 0.01, 1.0e6);
  estimation::CheckWithin(prefix + ".latency_ms", config.latency_ms, 0.0, 500.0);
  drift_ = drift_stream_.Normal3(config.drift_sigma);
  if (config.rate_hz > 0.0) {
    clock_.emplace(config.rate_hz);
    keep_ = std::exp(-1.0 / (config.rate_hz * config.drift_time));
  }
}

bool OwnNoise::Due(double t) { return clock_.has_value() && clock_->Due(t); }

Eigen::Vector3d OwnNoise::Draw() {
  Eigen::Vector3d error = drift_ + white_.Normal3(config_.sigma);
  drift_ =
      keep_ * drift_ + drift_stream_.Normal3(std::sqrt(1.0 - keep_ * keep_) * config_.drift_sigma);
  return error;
}

double OwnNoise::Claimed() const { return std::hypot(config_.sigma, config_.drift_sigma); }

OwnSensors::OwnSensors(const OwnSensorsConfig& config, std::uint64_t seed)
    : gps_config_(config.gps),
      outliers_(seed, "own gps outliers"),
      gps_(config.gps.sensor, seed, "own gps"),
      odometry_(config.odometry, seed, "own odometry"),
      height_(config.height, seed, "own height"),
      heading_(config.heading, seed, "own heading") {
  estimation::CheckWithin("own gps.vertical_factor", gps_config_.vertical_factor, 0.0, 10.0);
  estimation::CheckWithin("own gps.outage_begin", gps_config_.outage_begin, 0.0, 1.0e6);
  estimation::CheckWithin("own gps.outage_length", gps_config_.outage_length, 0.0, 1.0e6);
  estimation::CheckWithin("own gps.outlier_probability", gps_config_.outlier_probability, 0.0, 1.0);
  estimation::CheckWithin("own gps.outlier_size", gps_config_.outlier_size, 0.0, 1.0e6);
}

void OwnSensors::Sample(const estimation::VehicleState& vehicle) {
  const double t = vehicle.t;
  if (gps_.Due(t)) {  // all draws are used, so that a fault does not shift the others
    const Eigen::Vector3d factors(1.0, 1.0, gps_config_.vertical_factor);
    estimation::OwnPositionFix fix;
    fix.t = t;
    fix.p_WB = vehicle.p_WB + factors.cwiseProduct(gps_.Draw());
    fix.sigma_horizontal = gps_.Claimed();
    fix.sigma_vertical = gps_config_.vertical_factor * gps_.Claimed();
    const bool outlier = outliers_.Uniform(0.0, 1.0) < gps_config_.outlier_probability;
    const double direction = outliers_.Uniform(0.0, 2.0 * std::numbers::pi);
    if (outlier) {
      fix.p_WB.x() += gps_config_.outlier_size * std::cos(direction);
      fix.p_WB.y() += gps_config_.outlier_size * std::sin(direction);
    }
    const double into_outage = t - gps_config_.outage_begin;
    if (into_outage < 0.0 || into_outage >= gps_config_.outage_length) positions_.Push(fix);
  }
  if (odometry_.Due(t)) {
    const Eigen::Vector3d v_B = vehicle.q_WB.conjugate() * vehicle.v_WB;
    velocities_.Push({t, v_B + odometry_.Draw(), odometry_.Claimed()});
  }
  if (height_.Due(t)) {
    heights_.Push({t, vehicle.p_WB.z() + height_.Draw().x(), height_.Claimed()});
  }
  if (heading_.Due(t)) {
    const double yaw = estimation::Yaw(vehicle.q_WB) + heading_.Draw().x();
    headings_.Push({t, estimation::WrapAngle(yaw), heading_.Claimed()});
  }
}

std::optional<estimation::OwnPositionFix> OwnSensors::PollPosition(double t) {
  return positions_.Poll(t, gps_.latency());
}

std::optional<estimation::OwnVelocityFix> OwnSensors::PollVelocity(double t) {
  return velocities_.Poll(t, odometry_.latency());
}

std::optional<estimation::HeightSample> OwnSensors::PollHeight(double t) {
  return heights_.Poll(t, height_.latency());
}

std::optional<estimation::HeadingSample> OwnSensors::PollHeading(double t) {
  return headings_.Poll(t, heading_.latency());
}

}  // namespace touchdown::sim
