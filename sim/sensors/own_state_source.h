// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/sensors/imu.h"
#include "sim/sensors/own_sensors.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/own_state/own_state_filter.h"

namespace touchdown::sim {

struct OwnStateSourceConfig {
  ImuConfig imu;
  OwnSensorsConfig sensors;  ///< the GPS outage is in the trial's time, after the hover
  /// Its IMU noise, bias priors, IMU rate and reach are taken from the sensors above; its outage_after
  /// is no less than what two fixes of the faster of GPS and odometry take.
  estimation::OwnStateOptions filter;
  /// The vehicle hovers at its start for so long before t = 0, for the filter to start and settle
  /// [s], in [0.5, 600].
  double hover_before = 5.0;
  /// Without GPS or without heading sensor: how well the place and the heading of the take-off are
  /// known, 1 sigma.
  double takeoff_position_sigma = 0.02;  ///< [m], in [0, 100]
  double takeoff_heading_sigma = 0.035;  ///< [rad], in [0, 3]
};

/// The vehicle's own state as it knows it: sensors and filter in one, true states in, estimates
/// out.
/// The same configuration, seed and states give the same bits.
class OwnStateSource {
 public:
  /// Hovers at the pose of `start` before t = 0 in steps of `timestep` [s], in [1e-4, 0.01]. Throws
  /// std::invalid_argument naming key, value and range, and when the filter has not started by the
  /// hover's end.
  OwnStateSource(const OwnStateSourceConfig& config, std::uint64_t seed,
                 const estimation::VehicleState& start, double timestep);

  /// Feeds sensors and filter with the true state and gives the estimate for its time. Call once
  /// per simulation step, from t = timestep on. Does not allocate.
  estimation::VehicleState Step(const estimation::VehicleState& vehicle);

  /// The last estimate; before the first Step() that of the hover's end, at t = 0.
  const estimation::VehicleState& estimate() const { return estimate_; }

  /// The estimate for a time t [s] of the trial that has passed, as far back as the filter's
  /// history reaches, with what is known by now: for images that come late.
  estimation::VehicleState EstimateAt(double t) const;

  /// How far the estimate is to be trusted now.
  estimation::OwnStatus status() const { return filter_.Status(now_); }

  /// The filter itself: covariance, biases, counts. Its times are later than the simulation's by
  /// hover_before.
  const estimation::OwnStateFilter& filter() const { return filter_; }

  /// The sensors' true biases, for records and tests.
  const Imu& imu() const { return imu_; }

 private:
  void Feed(const estimation::VehicleState& vehicle);

  double hover_before_;
  Imu imu_;
  OwnSensors sensors_;
  estimation::OwnStateFilter filter_;
  double now_ = 0.0;  // on the filter's clock [s]
  estimation::VehicleState estimate_;
};

}  // namespace touchdown::sim
