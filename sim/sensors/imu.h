// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "estimation/base/sample_clock.h"
#include "sim/base/random_stream.h"
#include "touchdown/estimation/base/own_measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::sim {

/// Noise of an IMU, each axis. White noise and turn-on offsets are those of a MEMS IMU of the class
/// of Bosch's BMI088 (data sheet BST-BMI088-DS001: 190 ug/sqrt(Hz) and 0.014 deg/s/sqrt(Hz)). Its
/// offsets of 20 mg and 1 deg/s are calibrated to a quarter. The data sheet gives no bias walks:
/// they are those of the EuRoC MAV data set's ADIS16448 (Burri et al., IJRR 2016, sensor.yaml).
struct ImuConfig {
  double rate_hz = 500.0;                ///< [Hz], in [10, 1000]
  double accelerometer_noise = 1.86e-3;  ///< density [m/s^2/sqrt(Hz)], in [0, 1]
  double gyro_noise = 2.44e-4;           ///< density [rad/s/sqrt(Hz)], in [0, 0.1]
  double accelerometer_walk = 3e-3;      ///< of the bias [m/s^3/sqrt(Hz)], in [0, 1]
  double gyro_walk = 1.94e-5;            ///< of the bias [rad/s^2/sqrt(Hz)], in [0, 0.1]
  double accelerometer_offset = 0.05;    ///< 1 sigma of the bias at the start [m/s^2], in [0, 2]
  double gyro_offset = 5e-3;             ///< 1 sigma of the bias at the start [rad/s], in [0, 0.2]
};

/// IMU in the vehicle's centre of mass. It reads the mean specific force and the mean angular rate
/// since the sample before, as an IMU that integrates inside does. It has no scale error,
/// misalignment, clipping or vibration.
class Imu {
 public:
  /// `seed` feeds the streams "imu noise" and "imu bias". Throws std::invalid_argument naming key,
  /// value and range.
  Imu(const ImuConfig& config, std::uint64_t seed);

  /// A sample if one is due at the time t [s] of the vehicle's true state; the first call only
  /// remembers. Call once per simulation step, with states in time order. Does not allocate.
  std::optional<estimation::ImuSample> Poll(const estimation::VehicleState& vehicle);

  /// The true biases now [m/s^2], [rad/s].
  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_bias_; }
  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }

 private:
  ImuConfig config_;
  estimation::SampleClock clock_;
  RandomStream noise_;
  RandomStream bias_;
  Eigen::Vector3d accelerometer_bias_;
  Eigen::Vector3d gyro_bias_;
  std::optional<estimation::VehicleState> last_;
};

}  // namespace touchdown::sim
