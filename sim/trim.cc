// SPDX-License-Identifier: BSD-3-Clause
// Rotor drag depends on the attitude, so the trim is a fixed point; the map contracts by the ratio of
// rotor drag to weight, a few per cent at the speeds flown.
#include "touchdown/sim/trim.h"

#include <cmath>

#include "touchdown/sim/drag.h"

namespace touchdown::sim {
namespace {

constexpr int kIterations = 8;

Eigen::Matrix3d Attitude(const Eigen::Vector3d& z_B, double yaw) {
  const Eigen::Vector3d x_B =
      Eigen::Vector3d(-std::sin(yaw), std::cos(yaw), 0.0).cross(z_B).normalized();
  Eigen::Matrix3d R_WB;
  R_WB << x_B, z_B.cross(x_B), z_B;
  return R_WB;
}

}  // namespace

Trim TrimAt(const estimation::VehicleModel& model, const Eigen::Vector3d& u_W, double yaw) {
  Eigen::Vector3d thrust_W = model.HoverThrust() * Eigen::Vector3d::UnitZ();
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Matrix3d R_WB = Attitude(thrust_W.normalized(), yaw);
    thrust_W = model.HoverThrust() * Eigen::Vector3d::UnitZ() - DragForce(model, R_WB, u_W);
  }
  return {Eigen::Quaterniond(Attitude(thrust_W.normalized(), yaw)), thrust_W.norm()};
}

}  // namespace touchdown::sim
