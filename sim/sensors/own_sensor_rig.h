// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/sensors/imu.h"
#include "sim/sensors/own_sensors.h"
#include "touchdown/estimation/base/own_measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/own_state/own_state_options.h"

namespace touchdown::sim {

struct OwnSensorRigConfig {
  ImuConfig imu;
  OwnSensorsConfig sensors;  ///< the GPS outage is in the trial's time, after the hover
  /// The vehicle hovers at its start for so long before t = 0, for the filter to start and settle
  /// [s], in [0.5, 600].
  double hover_before = 5.0;
  /// Without GPS or without heading sensor: how well the place and the heading of the take-off are
  /// known, 1 sigma.
  double takeoff_position_sigma = 0.02;  ///< [m], in [0, 100]
  double takeoff_heading_sigma = 0.035;  ///< [rad], in [0, 3]
};

/// `options` with what a filter has to know of these sensors: IMU noise, bias priors, IMU rate, reach. Its outage_after
/// is at least as long as two fixes of the faster of GPS and odometry take.
estimation::OwnStateOptions FilterOptionsFor(const OwnSensorRigConfig& rig,
                                             const estimation::OwnStateOptions& options = {});

/// All sensors of the vehicle's own state: true states in, measurements out, to the `take` of the caller. Their clock
/// begins with the hover before the trial, so that no time is below zero: time stamps are ahead of the trial's by
/// hover_before. The same configuration, seed and states give the same bits.
class OwnSensorRig {
 public:
  /// Throws std::invalid_argument naming key, value and range.
  OwnSensorRig(const OwnSensorRigConfig& config, std::uint64_t seed);

  /// The hover at the pose of `start`, motionless, up to t = 0, in steps of `timestep` [s], in [1e-4, 0.01].
  template <typename Take>
  void Hover(const estimation::VehicleState& start, double timestep, Take&& take) {
    const Takeoff known = DrawTakeoff(start, timestep);
    if (known.has_position) take(known.position);
    if (known.has_heading) take(known.heading);
    estimation::VehicleState hover;
    hover.p_WB = start.p_WB;
    hover.q_WB = start.q_WB;
    for (long k = 0; k <= known.steps; ++k) {
      hover.t = static_cast<double>(k - known.steps) * timestep;
      Poll(hover, take);
    }
  }

  /// The measurements that arrive at the true state's time t of the trial. Call once per simulation step, from t =
  /// timestep on. In each step the IMU comes first, then what has arrived of the other sensors in a fixed order. Does
  /// not allocate.
  template <typename Take>
  void Poll(const estimation::VehicleState& vehicle, Take&& take) {
    estimation::VehicleState shifted = vehicle;
    shifted.t = vehicle.t + config_.hover_before;
    if (const auto sample = imu_.Poll(shifted)) take(*sample);
    sensors_.Sample(shifted);
    while (const auto fix = sensors_.PollPosition(shifted.t)) take(*fix);
    while (const auto fix = sensors_.PollVelocity(shifted.t)) take(*fix);
    while (const auto sample = sensors_.PollHeight(shifted.t)) take(*sample);
    while (const auto sample = sensors_.PollHeading(shifted.t)) take(*sample);
  }

  /// The true biases, for records and tests.
  const Imu& imu() const { return imu_; }
  const OwnSensorRigConfig& config() const { return config_; }

 private:
  struct Takeoff {
    bool has_position = false, has_heading = false;
    estimation::OwnPositionFix position;
    estimation::HeadingSample heading;
    long steps = 0;
  };
  Takeoff DrawTakeoff(const estimation::VehicleState& start, double timestep) const;

  OwnSensorRigConfig config_;
  std::uint64_t seed_;
  Imu imu_;
  OwnSensors sensors_;
};

}  // namespace touchdown::sim
