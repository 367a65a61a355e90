// SPDX-License-Identifier: BSD-3-Clause
// A loop of frequency w asks for w^2 e of angular acceleration at an error e: with what the rotors have left at hover,
// the error at which it saturates is turn / w^2. It has to stay as far below 1 / lag. Both are kept where the
// default frequencies have them with the vehicle that comes with the library; a vehicle that has more is not driven
// faster.

#include "control/tracking/vehicle_frequencies.h"

#include <algorithm>
#include <cmath>

namespace touchdown::control {
namespace {

constexpr double kTiltError = 0.70;  // at which roll and pitch saturate [rad]
constexpr double kYawError = 0.64;   // [rad]
constexpr double kLagTimes = 0.50;   // attitude_frequency over 1 / lag

}  // namespace

Quickness QuicknessOf(const estimation::VehicleModel& model) {
  const ControllerOptions options;
  const Eigen::Vector3d turn = estimation::HoverTurn(model);
  Quickness quickness;
  quickness.height = std::min(1.0, kLagTimes / model.rotor_lag_s / options.attitude_frequency);
  quickness.tilt = std::min(quickness.height, std::sqrt(turn.head<2>().minCoeff() / kTiltError) /
                                                  options.attitude_frequency);
  quickness.yaw =
      std::min(quickness.height, std::sqrt(turn.z() / kYawError) / options.yaw_frequency);
  return quickness;
}

ControllerOptions OptionsFor(const estimation::VehicleModel& model) {
  const Quickness quickness = QuicknessOf(model);
  ControllerOptions options;
  options.attitude_frequency *= quickness.tilt;
  options.position_frequency *= quickness.tilt;
  options.height_frequency *= quickness.height;
  options.yaw_frequency *= quickness.yaw;
  return options;
}

DisturbanceObserverOptions ObserverFor(const estimation::VehicleModel& model) {
  const Quickness quickness = QuicknessOf(model);
  DisturbanceObserverOptions options;
  options.force_bandwidth *= quickness.tilt;
  options.moment_bandwidth *= quickness.tilt;
  return options;
}

}  // namespace touchdown::control
