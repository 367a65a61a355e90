// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"
#include "sim/rendering/scene_mjcf.h"
#include "touchdown/estimation/base/measurements.h"

namespace touchdown::evaluation {

/// What a chase camera looks at in one picture.
struct ChaseSubject {
  Eigen::Vector3d vehicle_W = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d target_W = Eigen::Vector3d::Zero();   ///< pad or goal [m]
};

/// The part of the picture that is free for the subject, as shares of width and height.
struct ChaseFrame {
  double left = 0.06, right = 0.72, top = 0.08, bottom = 0.84;
};

/// The chase camera's place in each picture of a flight: behind and above the vehicle, with vehicle and target in the
/// frame. Where obstacles hide them it looks from elsewhere. It keeps away from obstacles and moves smoothly.
/// @param dt from one picture to the next [s].
std::vector<sim::CameraPose> ChaseFlight(const std::vector<ChaseSubject>& subjects, double dt,
                                         const sim::ObstacleField& obstacles,
                                         const estimation::CameraIntrinsics& camera,
                                         const ChaseFrame& frame = {});

}  // namespace touchdown::evaluation
