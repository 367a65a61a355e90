// SPDX-License-Identifier: BSD-3-Clause
// Inputs and outputs of OwnStateFilter: options, outcomes, status, counts.
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "touchdown/estimation/own_state/own_state_model.h"

namespace touchdown::estimation {

/// The sensors that correct the propagation.
enum class OwnSensor { kPosition, kVelocity, kHeight, kHeading };
inline constexpr int kOwnSensors = 4;
std::string_view ToString(OwnSensor sensor);

/// What became of a measurement.
enum class OwnUpdate {
  kWaiting,       ///< kept for the start; the filter does not run yet
  kStarted,       ///< the IMU sample that completed what the start needs
  kAccepted,      ///< in time order
  kAcceptedLate,  ///< older than the newest one; the newer ones were processed again
  kGated,         ///< too unlikely; nothing changed but the count
  kReset,         ///< a position that was gated too often in a row: taken over as it is
  kTooOld,        ///< older than the history reaches, or an IMU sample out of order
  kInvalid,       ///< not finite, a standard deviation below zero, or ahead of the
                  ///< newest IMU sample by more than max_imu_gap
};
std::string_view ToString(OwnUpdate update);

/// How far the estimate is to be trusted.
enum class OwnStatus {
  kNoImu,      ///< no IMU sample has come
  kAligning,   ///< not started: what is missing, hovering for long enough, a position, a heading
  kGood,       ///< runs on fresh measurements
  kOutage,     ///< no position or velocity was accepted for long: dead reckoning
  kUncertain,  ///< 1 sigma of position, velocity or attitude beyond what control can use
  kImuStale,   ///< the newest IMU sample is too old
};
std::string_view ToString(OwnStatus status);
/// One sentence that says what the status means for who uses the estimate.
std::string_view Sentence(OwnStatus status);

/// 1 sigma of each part of a start.
struct OwnStartSigma {
  double position = 0.05;       ///< each axis [m]
  double velocity = 0.1;        ///< each axis [m/s]
  double tilt = 0.02;           ///< roll and pitch [rad]
  double yaw = 0.05;            ///< [rad]
  double accelerometer = 0.05;  ///< bias, each axis [m/s^2]
  double gyro = 5e-3;           ///< bias, each axis [rad/s]
};

/// A measurement that claims a smaller standard deviation is taken as this good: exact sensors must
/// not make the covariance singular. [m, m/s, rad]
inline constexpr double kLeastOwnSigma = 1e-3;

struct OwnStateOptions {
  ImuNoise imu;
  OwnStartSigma prior;  ///< its biases and velocity hold for the start from a hover too

  // The start from a hover: means over this time, taken as gravity, bias and the vehicle's motion.
  double hover_time = 1.0;           ///< [s], in [0.05, 60]
  double hover_acceleration = 0.05;  ///< 1 sigma of the mean acceleration of a hover [m/s^2]
  double hover_rate = 0.01;          ///< 1 sigma of the mean angular rate of a hover [rad/s]

  double gate_probability = 0.999;  ///< a good measurement passes with this probability, in (0, 1)
  int reset_after = 20;             ///< positions gated in a row, >= 2
  double max_delay = 0.5;           ///< late measurements are taken up to this age [s], in [0, 5]
  double imu_rate_hz = 500.0;       ///< at most, for the size of the history, in [10, 2000]

  double max_imu_gap = 0.05;      ///< a longer one adds to the covariance what follows [s], > 0
  double gap_acceleration = 6.0;  ///< 1 sigma of the acceleration not seen [m/s^2]
  double gap_rate = 2.0;          ///< 1 sigma of the angular rate not seen [rad/s]
  double outage_after = 0.5;      ///< no position, no velocity for longer: kOutage [s], > 0
  double usable_position = 2.0;   ///< 1 sigma beyond which the status is kUncertain [m] ...
  double usable_velocity = 1.0;   ///< [m/s]
  double usable_attitude = 0.35;  ///< [rad]
};

/// Throws std::invalid_argument naming the first option out of its range, its value and the range.
void Validate(const OwnStateOptions& options);

/// The same for the sigmas of a start.
void Validate(const OwnStartSigma& sigma);

/// Counts since the start, by sensor, and times of the last accepted measurements.
struct OwnDiagnostics {
  struct Sensor {
    int accepted = 0;
    int gated = 0;
    int gated_in_row = 0;
    double last_t = -std::numeric_limits<double>::infinity();  ///< last accepted [s]
  };
  std::array<Sensor, kOwnSensors> sensors;
  int imu_samples = 0;
  int imu_gaps = 0;
  int resets = 0;
  int late_accepted = 0;
  int too_old = 0;
  int invalid = 0;

  const Sensor& of(OwnSensor sensor) const { return sensors[static_cast<std::size_t>(sensor)]; }
  Sensor& of(OwnSensor sensor) { return sensors[static_cast<std::size_t>(sensor)]; }
};

}  // namespace touchdown::estimation
