// SPDX-License-Identifier: BSD-3-Clause
// Rotor drag depends on the attitude, so the trim is a fixed point. The map contracts by the ratio of rotor drag to
// weight, a few per cent at the speeds flown. Where it does not contract, there is no trim.
#include "sim/vehicle/trim.h"

#include <cmath>

#include "sim/air/drag.h"

namespace touchdown::sim {
namespace {

constexpr int kIterations = 12;
constexpr double kConverged = 1e-6;

Eigen::Matrix3d Attitude(const Eigen::Vector3d& z_B, double yaw) {
  const Eigen::Vector3d x_B =
      Eigen::Vector3d(-std::sin(yaw), std::cos(yaw), 0.0).cross(z_B).normalized();
  Eigen::Matrix3d R_WB;
  R_WB << x_B, z_B.cross(x_B), z_B;
  return R_WB;
}

}  // namespace

std::optional<Trim> TrimAt(const estimation::VehicleModel& model, const Eigen::Vector3d& u_W,
                           double yaw) {
  const Eigen::Vector3d lift_W = model.HoverThrust() * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d thrust_W = lift_W;
  double change = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Vector3d before = thrust_W;
    thrust_W = lift_W - DragForce(model, Attitude(before.normalized(), yaw), u_W);
    if (!(thrust_W.z() > 0.0)) return std::nullopt;
    change = (thrust_W - before).norm();
  }
  const double thrust = thrust_W.norm();
  if (change > kConverged * thrust || thrust > estimation::AllocationOf(model).thrust_max)
    return std::nullopt;
  return Trim{Eigen::Quaterniond(Attitude(thrust_W.normalized(), yaw)), thrust};
}

}  // namespace touchdown::sim
