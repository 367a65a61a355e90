// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include <Eigen/Core>

#include "touchdown/estimation/vehicle_model.h"

namespace touchdown::evaluation {

/// Unit thrust axis in W at which the vehicle holds its velocity: thrust, gravity and the drag of
/// the velocity through air `u_W` [m/s] add up to nothing.
Eigen::Vector3d EquilibriumAxis(const estimation::VehicleModel& model, const Eigen::Vector3d& u_W);

/// Mean over the last second of what is added, one value per call.
class SlidingMean {
 public:
  void Add(double t, const Eigen::Vector3d& value);
  Eigen::Vector3d Mean() const;  ///< zero before the first value

 private:
  std::deque<std::pair<double, Eigen::Vector3d>> values_;
};

}  // namespace touchdown::evaluation
