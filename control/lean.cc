// SPDX-License-Identifier: BSD-3-Clause
// Leaning by t towards a foot at radius r and depth d, the foot is d cos t + r sin t below the centre
// of mass, the rim of a hull of radius R and depth D is D cos t + R sin t: equal at
// tan t = (d - D) / (R - r). Towards the middle between two feet r is smaller, and so is t.

#include "touchdown/control/lean.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "touchdown/estimation/vehicle_state.h"

namespace touchdown::control {

double FeetFirstTilt(const estimation::VehicleModel& model) {
  return std::atan2(model.foot_depth - model.hull_bottom,
                    std::max(1e-9, model.hull_radius - model.foot_radius));
}

double LeanUnder(double weight, const Eigen::Vector3d& force_W) {
  return std::atan2(force_W.head<2>().norm(), weight - force_W.z());
}

double HeadingIntoWind(const estimation::VehicleModel& model, const Eigen::Vector3d& force_W,
                       double wanted) {
  if (!(force_W.head<2>().norm() > 0.0)) return wanted;
  const double lean = std::atan2(-force_W.y(), -force_W.x());
  double nearest = 2.0 * std::numbers::pi;
  for (const double azimuth : model.foot_azimuths) {
    const double turn = estimation::WrapAngle(lean - azimuth - wanted);
    if (std::abs(turn) < std::abs(nearest)) nearest = turn;
  }
  return model.foot_azimuths.empty() ? wanted : estimation::WrapAngle(wanted + nearest);
}

}  // namespace touchdown::control
