// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <memory>
#include <string_view>

#include <Eigen/Core>

#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/planning/spline/flatness.h"

namespace touchdown::control {

/// Collective thrust along z_B and moment about B's axes: the paper's [U1, U2, U3, U4].
struct Wrench {
  double thrust = 0.0;                                 ///< [N]
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  ///< [N m]
};

/// The forces on the vehicle beside gravity, the rotors and the drag in still air that its model
/// has.
struct Disturbance {
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  ///< [N m]
  /// True thrust over true mass, over the same of the model [-].
  double thrust_gain = 1.0;
};

/// A wrench, and how it came about (for records and tests).
struct ControlOutput {
  Wrench wrench;
  Eigen::Matrix3d R_WB_desired = Eigen::Matrix3d::Identity();
  Eigen::Vector3d w_WB_B_desired = Eigen::Vector3d::Zero();  ///< in the desired frame [rad/s]
  bool tilt_limited = false;
  bool thrust_limited = false;
};

/// Gains as closed-loop frequencies and damping ratios; mass and inertia scale them. The defaults
/// leave room for a rotor lag of 35 ms; OptionsFor has those of a vehicle.
struct ControllerOptions {
  double position_frequency = 2.8;    ///< horizontal [rad/s]
  double position_damping = 0.9;      ///< [-]
  double height_frequency = 3.5;      ///< vertical [rad/s]
  double height_damping = 0.9;        ///< [-]
  double attitude_frequency = 14.0;   ///< roll and pitch [rad/s]
  double attitude_damping = 0.9;      ///< [-]
  double yaw_frequency = 4.0;         ///< [rad/s]
  double yaw_damping = 1.0;           ///< [-]
  double tilt_max = 0.87;             ///< of the desired thrust, in (0, pi/2) [rad]
  double thrust_fraction_max = 0.95;  ///< of the vehicle's greatest thrust, in (0, 1] [-]
  double thrust_fraction_min =
      0.15;  ///< of the hover thrust: the desired force's least vertical [-]
};

/// The default options, with lower frequencies for a vehicle that turns more slowly (docs/vehicles.md). Throws
/// std::invalid_argument as estimation::AllocationOf does.
ControllerOptions OptionsFor(const estimation::VehicleModel& model);

/// Throws std::invalid_argument naming the first option out of its range.
void Validate(const ControllerOptions& options);

/// Throws std::invalid_argument naming the first figure of the model that no controller can use.
void Validate(const estimation::VehicleModel& model);

/// A tracking law without memory: the same inputs give the same output.
class Controller {
 public:
  virtual ~Controller() = default;

  /// Does not allocate. Inputs that are not finite give an output that is not finite.
  /// @param disturbance to compensate; the law "paper", as published, ignores it.
  /// @param tilt_most of the desired thrust, besides the options' tilt_max, > 0 [rad].
  virtual ControlOutput Update(
      const estimation::VehicleState& state, const planning::FlatState& reference,
      const Disturbance& disturbance = {},
      double tilt_most = std::numeric_limits<double>::infinity()) const noexcept = 0;
};

/// "geometric" or "paper". Throws std::invalid_argument for any other name.
std::unique_ptr<Controller> MakeController(std::string_view name,
                                           const estimation::VehicleModel& model,
                                           const ControllerOptions& options = {});

}  // namespace touchdown::control
