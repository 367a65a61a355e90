// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that holds still in wind leans against it. In a landing its feet must still touch
// first, not the hull's rim.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::control {

/// The greatest lean towards a foot at which the foot touches a level deck before the hull's rim
/// does [rad].
double FeetFirstTilt(const estimation::VehicleModel& model);

/// The same towards where a vehicle of attitude q_WB leans, which may be between two feet.
double FeetFirstTilt(const estimation::VehicleModel& model, const Eigen::Quaterniond& q_WB);

/// How much lower the lowest foot is than with a level vehicle [m]; 0 without azimuths.
double FootDrop(const estimation::VehicleModel& model, const Eigen::Quaterniond& q_WB);

/// The tilt at which a vehicle of weight `weight` [N] holds still under `force_W` [N] [rad].
double LeanUnder(double weight, const Eigen::Vector3d& force_W);

/// Heading [rad] that brings a foot to the side a vehicle leans to under the horizontal part of
/// `force_W` [N]. Of all such headings it is the nearest to `wanted` [rad]. `wanted` itself without
/// a force or without feet.
double HeadingIntoWind(const estimation::VehicleModel& model, const Eigen::Vector3d& force_W,
                       double wanted);

}  // namespace touchdown::control
