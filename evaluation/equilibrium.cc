// SPDX-License-Identifier: BSD-3-Clause
// The success rule measures tilt from the attitude that steady flight through the air needs. Rotor
// drag depends on that attitude, so the axis is a fixed point; the map contracts by the ratio of
// rotor drag to weight, a few per cent at the speeds flown.
#include "touchdown/evaluation/equilibrium.h"

#include "touchdown/planning/flatness.h"
#include "touchdown/sim/drag.h"

namespace touchdown::evaluation {
namespace {

constexpr int kIterations = 8;
constexpr double kWindow = 1.0;  // [s]

}  // namespace

Eigen::Vector3d EquilibriumAxis(const estimation::VehicleModel& model, const Eigen::Vector3d& u_W) {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Matrix3d R_WB = planning::AttitudeFromThrust(axis, 0.0);
    const Eigen::Vector3d thrust =
        model.HoverThrust() * Eigen::Vector3d::UnitZ() - sim::DragForce(model, R_WB, u_W);
    axis = thrust.normalized();
  }
  return axis;
}

void SlidingMean::Add(double t, const Eigen::Vector3d& value) {
  values_.emplace_back(t, value);
  while (values_.front().first < t - kWindow) values_.pop_front();
}

Eigen::Vector3d SlidingMean::Mean() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [t, value] : values_) sum += value;
  return values_.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(values_.size()));
}

}  // namespace touchdown::evaluation
