// SPDX-License-Identifier: BSD-3-Clause
// A loop of frequency w demands an angular acceleration of w^2 e at an error e. It saturates at the
// error turn / w^2, where turn is what the actuators can still give at hover. This error is kept
// where the default frequencies have it for the library's default vehicle. A vehicle that has more
// is not driven faster. A longer lag of the rotors needs no lower frequencies: RotorLead
// compensates it (docs/vehicles.md has the flights).

#include "control/tracking/vehicle_frequencies.h"

#include <algorithm>
#include <cmath>

namespace touchdown::control {
namespace {

constexpr double kTiltError = 0.70;  // at which roll and pitch saturate [rad]
constexpr double kYawError = 0.64;   // [rad]

double Share(double turn, double error, double frequency) {
  return std::min(1.0, std::sqrt(turn / error) / frequency);
}

}  // namespace

BandwidthRatio BandwidthRatioOf(const estimation::VehicleModel& model) {
  const ControllerOptions options;
  const Eigen::Vector3d turn = estimation::HoverTurn(model);
  return {Share(turn.head<2>().minCoeff(), kTiltError, options.attitude_frequency),
          Share(turn.z(), kYawError, options.yaw_frequency)};
}

ControllerOptions OptionsFor(const estimation::VehicleModel& model) {
  const BandwidthRatio ratio = BandwidthRatioOf(model);
  ControllerOptions options;
  options.attitude_frequency *= ratio.tilt;
  options.position_frequency *= ratio.tilt;
  options.yaw_frequency *= ratio.yaw;
  return options;
}

DisturbanceObserverOptions ObserverFor(const estimation::VehicleModel& model) {
  const BandwidthRatio ratio = BandwidthRatioOf(model);
  DisturbanceObserverOptions options;
  options.force_bandwidth *= ratio.tilt;
  options.moment_bandwidth *= ratio.tilt;
  return options;
}

}  // namespace touchdown::control
