// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "sim/air/dryden.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::sim {

/// Wind as plain data; the defaults are still air.
struct WindConfig {
  double mean = 0.0;       ///< speed of the mean wind, horizontal [m/s], in [0, 30]
  double max = 0.0;        ///< greatest speed with turbulence [m/s], in [mean, 40]; mean: steady
  double direction = 0.0;  ///< where the wind blows to, from x_W, left positive [rad]

  /// A 1-cosine gust along the mean wind, on top of it and of `max`.
  struct Gust {
    double speed = 0.0;     ///< at its height [m/s], in [0, 30]; 0: none
    double start = 0.0;     ///< of the first one [s], >= 0
    double duration = 2.0;  ///< from nothing to nothing [s], > 0
    double period = 0.0;    ///< from one start to the next [s], >= duration; 0: one gust only
  } gust;
};

/// Velocity of the air at the vehicle: mean, Dryden turbulence, gusts. The standard deviation of the horizontal
/// turbulence is (max - mean) / 2. The sum of mean and turbulence is shortened to `max` where it is longer. The same
/// seed and flight give the same bits. Not to be shared between threads.
class Wind {
 public:
  /// Throws std::invalid_argument naming the key, its value and the allowed range.
  Wind(const WindConfig& config, std::uint64_t seed);

  /// The air's velocity in W [m/s] for the time step of length `dt` [s] that begins with the
  /// vehicle's true state. Call once per step. Does not allocate.
  Eigen::Vector3d Step(const estimation::VehicleState& vehicle, double dt);

  /// Speed of the gust alone at time t [m/s].
  double GustAt(double t) const;

 private:
  WindConfig config_;
  Eigen::Vector3d along_;  ///< unit vector of the mean wind, in W
  Eigen::Vector3d left_;   ///< to its left, in W
  DrydenTurbulence turbulence_;
};

}  // namespace touchdown::sim
