// SPDX-License-Identifier: BSD-3-Clause
// Names, sentences and ranges of the own-state filter's options and outcomes.

#include "touchdown/estimation/own_state/own_state_options.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace touchdown::estimation {
namespace {

void Require(bool good, const char* name, double value, const char* range) {
  if (good) return;
  std::ostringstream message;
  message << "OwnStateOptions." << name << " = " << value << ", allowed: " << range;
  throw std::invalid_argument(message.str());
}

void RequirePositive(const char* name, double value) {
  Require(value > 0.0 && std::isfinite(value), name, value, "> 0");
}

void RequireNotNegative(const char* name, double value) {
  Require(value >= 0.0 && std::isfinite(value), name, value, ">= 0");
}

void RequireWithin(const char* name, double value, double low, double high, const char* range) {
  Require(value >= low && value <= high, name, value, range);
}

}  // namespace

std::string_view ToString(OwnSensor sensor) {
  switch (sensor) {
    case OwnSensor::kPosition:
      return "position";
    case OwnSensor::kVelocity:
      return "velocity";
    case OwnSensor::kHeight:
      return "height";
    case OwnSensor::kHeading:
      return "heading";
  }
  return "unknown";
}

std::string_view ToString(OwnUpdate update) {
  switch (update) {
    case OwnUpdate::kWaiting:
      return "waiting";
    case OwnUpdate::kStarted:
      return "started";
    case OwnUpdate::kAccepted:
      return "accepted";
    case OwnUpdate::kAcceptedLate:
      return "accepted_late";
    case OwnUpdate::kGated:
      return "gated";
    case OwnUpdate::kReset:
      return "reset";
    case OwnUpdate::kTooOld:
      return "too_old";
    case OwnUpdate::kInvalid:
      return "invalid";
  }
  return "unknown";
}

std::string_view ToString(OwnStatus status) {
  switch (status) {
    case OwnStatus::kNoImu:
      return "no_imu";
    case OwnStatus::kAligning:
      return "aligning";
    case OwnStatus::kGood:
      return "good";
    case OwnStatus::kOutage:
      return "outage";
    case OwnStatus::kUncertain:
      return "uncertain";
    case OwnStatus::kImuStale:
      return "imu_stale";
  }
  return "unknown";
}

std::string_view Sentence(OwnStatus status) {
  switch (status) {
    case OwnStatus::kNoImu:
      return "No IMU sample has come, so that there is no estimate.";
    case OwnStatus::kAligning:
      return "The filter waits for a hover of the set time, a position and a heading to start "
             "from.";
    case OwnStatus::kGood:
      return "The estimate runs on fresh measurements.";
    case OwnStatus::kOutage:
      return "No position or velocity was accepted for longer than outage_after: the estimate is "
             "dead reckoning and its covariance grows.";
    case OwnStatus::kUncertain:
      return "The covariance of position, velocity or attitude is beyond what control can use.";
    case OwnStatus::kImuStale:
      return "The newest IMU sample is older than max_imu_gap: attitude and rate are not known.";
  }
  return "Unknown status.";
}

void Validate(const OwnStartSigma& sigma) {
  RequirePositive("prior.position", sigma.position);
  RequirePositive("prior.velocity", sigma.velocity);
  RequirePositive("prior.tilt", sigma.tilt);
  RequirePositive("prior.yaw", sigma.yaw);
  RequirePositive("prior.accelerometer", sigma.accelerometer);
  RequirePositive("prior.gyro", sigma.gyro);
}

void Validate(const OwnStateOptions& options) {
  RequirePositive("imu.accelerometer", options.imu.accelerometer);
  RequirePositive("imu.gyro", options.imu.gyro);
  RequireNotNegative("imu.accelerometer_walk", options.imu.accelerometer_walk);
  RequireNotNegative("imu.gyro_walk", options.imu.gyro_walk);
  Validate(options.prior);
  RequireWithin("hover_time", options.hover_time, 0.05, 60.0, "[0.05, 60]");
  RequirePositive("hover_acceleration", options.hover_acceleration);
  RequirePositive("hover_rate", options.hover_rate);
  Require(options.gate_probability > 0.0 && options.gate_probability < 1.0, "gate_probability",
          options.gate_probability, "(0, 1)");
  Require(options.reset_after >= 2, "reset_after", options.reset_after, ">= 2");
  RequireWithin("max_delay", options.max_delay, 0.0, 5.0, "[0, 5]");
  RequireWithin("imu_rate_hz", options.imu_rate_hz, 10.0, 2000.0, "[10, 2000]");
  RequirePositive("max_imu_gap", options.max_imu_gap);
  RequireNotNegative("gap_acceleration", options.gap_acceleration);
  RequireNotNegative("gap_rate", options.gap_rate);
  RequirePositive("outage_after", options.outage_after);
  RequirePositive("usable_position", options.usable_position);
  RequirePositive("usable_velocity", options.usable_velocity);
  RequirePositive("usable_attitude", options.usable_attitude);
}

}  // namespace touchdown::estimation
