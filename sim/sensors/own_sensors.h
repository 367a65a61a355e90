// SPDX-License-Identifier: BSD-3-Clause
// The vehicle's sensors beside the IMU: position, velocity, height, heading. Each samples at its
// rate, stamps the sample with that time and hands it out `latency_ms` later; each has its own
// random streams. None allocates after construction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "estimation/base/sample_clock.h"
#include "sim/base/random_stream.h"
#include "touchdown/estimation/base/own_measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::sim {

/// Rate, noise and delay of a sensor. `drift_sigma` is that of an error with memory beside the
/// white noise, a first-order Gauss-Markov process of `drift_time`. The sensor states both together
/// as if they were white, as receivers do. A filter that believes this is overconfident.
struct OwnSensorConfig {
  double rate_hz = 10.0;     ///< [Hz], in (0, 1000]; 0: the sensor is off
  double sigma = 0.0;        ///< white noise, each axis [sensor's unit], in [0, 100]
  double drift_sigma = 0.0;  ///< error with memory, each axis [sensor's unit], in [0, 100]
  double drift_time = 60.0;  ///< its time constant [s], in [0.01, 1e6]
  double latency_ms = 0.0;   ///< [ms], in [0, 500]
};

/// GPS with RTK corrections, of the class of u-blox's ZED-F9P (data sheet: 10 mm + 1 ppm CEP). The
/// noise is doubled for a vehicle in motion. Vertical noise is `vertical_factor` times the
/// horizontal.
struct OwnGpsConfig {
  OwnSensorConfig sensor{10.0, 0.02, 0.0, 60.0, 100.0};  ///< [m]
  double vertical_factor = 2.0;                          ///< in [0, 10]
  double outage_begin = 0.0;         ///< no fixes from this time on [s], >= 0 ...
  double outage_length = 0.0;        ///< ... for so long [s], >= 0
  double outlier_probability = 0.0;  ///< of each fix, in [0, 1]
  double outlier_size = 5.0;  ///< added to such a fix in a random horizontal direction [m], >= 0
};

/// What the vehicle carries. Off by default: odometry.
struct OwnSensorsConfig {
  OwnGpsConfig gps;
  OwnSensorConfig odometry{0.0, 0.03, 0.01, 10.0, 30.0};  ///< velocity in B [m/s]
  OwnSensorConfig height{25.0, 0.1, 0.0, 60.0, 20.0};     ///< [m]
  OwnSensorConfig heading{25.0, 0.035, 0.0, 60.0, 20.0};  ///< [rad]
};

/// White noise and drift of one sensor of up to three axes.
class OwnNoise {
 public:
  /// `seed` and `name` feed its stream; `name` is what errors begin with. Throws
  /// std::invalid_argument naming key, value and range.
  OwnNoise(const OwnSensorConfig& config, std::uint64_t seed, std::string_view name);

  /// True once for each sample time passed by `t` [s]; never for a sensor that is off.
  bool Due(double t);

  /// The errors of the sample now due.
  Eigen::Vector3d Draw();

  /// What the sensor claims, each axis: white and drift together [sensor's unit].
  double Claimed() const;

  double latency() const { return 1e-3 * config_.latency_ms; }  ///< [s]

 private:
  OwnSensorConfig config_;
  std::optional<estimation::SampleClock> clock_;
  RandomStream white_;
  RandomStream drift_stream_;
  Eigen::Vector3d drift_;
  double keep_ = 0.0;  // of the drift, from one sample to the next
};

/// Holds samples back by a fixed delay; up to kHeld of them.
template <typename Sample>
class DelayLine {
 public:
  static constexpr std::size_t kHeld = 512;

  void Push(const Sample& sample) {
    if (size_ == kHeld) Pop();  // never at [0, 500] ms and 1000 Hz
    samples_[(first_ + size_++) % kHeld] = sample;
  }

  /// The oldest sample that is at least `delay` [s] old at the time t [s].
  std::optional<Sample> Poll(double t, double delay) {
    constexpr double kTolerance = 1.0e-7;  // [s], far below a time step
    if (size_ == 0 || samples_[first_].t + delay > t + kTolerance) return std::nullopt;
    const Sample sample = samples_[first_];
    Pop();
    return sample;
  }

 private:
  void Pop() {
    first_ = (first_ + 1) % kHeld;
    --size_;
  }

  std::array<Sample, kHeld> samples_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

/// All sensors of the vehicle's own state but the IMU.
class OwnSensors {
 public:
  /// `seed` feeds the streams "own gps", "own odometry", "own height" and "own heading", each
  /// also with " drift", and "own gps outliers". Throws std::invalid_argument naming key, value and
  /// range.
  OwnSensors(const OwnSensorsConfig& config, std::uint64_t seed);

  /// Takes the samples that are due at the true state's time. Call once per simulation step, before
  /// the polls.
  void Sample(const estimation::VehicleState& vehicle);

  /// What has arrived by the time t [s], the oldest first; call each until there is none.
  std::optional<estimation::OwnPositionFix> PollPosition(double t);
  std::optional<estimation::OwnVelocityFix> PollVelocity(double t);
  std::optional<estimation::HeightSample> PollHeight(double t);
  std::optional<estimation::HeadingSample> PollHeading(double t);

 private:
  OwnGpsConfig gps_config_;
  RandomStream outliers_;
  OwnNoise gps_;
  OwnNoise odometry_;
  OwnNoise height_;
  OwnNoise heading_;
  DelayLine<estimation::OwnPositionFix> positions_;
  DelayLine<estimation::OwnVelocityFix> velocities_;
  DelayLine<estimation::HeightSample> heights_;
  DelayLine<estimation::HeadingSample> headings_;
};

}  // namespace touchdown::sim
