// SPDX-License-Identifier: BSD-3-Clause
// A vehicle leans by t towards a foot at radius r and depth d. The foot is then d cos t + r sin t
// below the centre of mass. The rim of a hull of radius R and depth D is D cos t + R sin t below
// it. Both are equal at tan t = (d - D) / (R - r). Towards the middle between two feet r is
// smaller, and so is t.

#include "control/tracking/lean.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::control {

namespace {

/// With the nearest foot at `reach` towards the low side [m].
double FeetFirstTilt(const estimation::VehicleModel& model, double reach) {
  return std::atan2(model.foot_depth - model.hull_bottom,
                    std::max(1e-9, model.hull_radius - reach));
}

}  // namespace

double FeetFirstTilt(const estimation::VehicleModel& model) {
  return FeetFirstTilt(model, model.foot_radius);
}

double FeetFirstTilt(const estimation::VehicleModel& model, const Eigen::Quaterniond& q_WB) {
  const Eigen::Vector3d down_B = q_WB.conjugate() * -Eigen::Vector3d::UnitZ();
  const double low = std::atan2(down_B.y(), down_B.x());
  double reach = model.foot_azimuths.empty() ? model.foot_radius : -model.foot_radius;
  for (const double azimuth : model.foot_azimuths) {
    reach = std::max(reach, model.foot_radius * std::cos(azimuth - low));
  }
  return FeetFirstTilt(model, reach);
}

double FootDrop(const estimation::VehicleModel& model, const Eigen::Quaterniond& q_WB) {
  const Eigen::Vector3d up_B = q_WB.conjugate() * Eigen::Vector3d::UnitZ();
  double drop = 0.0;
  for (const double azimuth : model.foot_azimuths) {
    const Eigen::Vector3d p_BF(model.foot_radius * std::cos(azimuth),
                               model.foot_radius * std::sin(azimuth), -model.foot_depth);
    drop = std::max(drop, -model.foot_depth - up_B.dot(p_BF));
  }
  return drop;
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
