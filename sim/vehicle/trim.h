// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

/// Attitude and thrust with which a vehicle holds its velocity.
struct Trim {
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  double thrust = 0.0;  ///< of all rotors together [N]
};

/// The trim in which thrust, gravity and the drag of the velocity through air `u_W` [m/s] balance.
/// B's x axis points to `yaw` [rad], seen from above. Empty where the rotors cannot do that. Does
/// not allocate.
std::optional<Trim> TrimAt(const estimation::VehicleModel& model, const Eigen::Vector3d& u_W,
                           double yaw);

}  // namespace touchdown::sim
