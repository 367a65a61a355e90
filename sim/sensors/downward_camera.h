// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace touchdown::sim {

/// The axes of the camera that looks for the pad, in B: rotation C to B. C: x right (x_B), y down (-y_B), z down.
inline Eigen::Matrix3d DownwardCameraAxes() {
  return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
}

}  // namespace touchdown::sim
