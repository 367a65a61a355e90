// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/base/random_stream.h"
#include "sim/obstacles/obstacle_field.h"
#include "sim/pad/pad_geometry.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

/// Depth camera, by default at the vehicle's nose, forward. C: x right, y down, z along the optical axis.
struct DepthCameraConfig {
  int width = 80;                           ///< [pixel], in [1, 4096]
  int height = 60;                          ///< [pixel], in [1, 4096]
  double fov_x_deg = 90.0;                  ///< horizontal field of view [deg], in (0, 170]
  double max_range = 6.0;                   ///< along the ray [m], in (0, 100]
  Eigen::Vector3d p_BC = {0.10, 0.0, 0.0};  ///< camera in B [m]
  double yaw_deg = 0.0;                     ///< optical axis to the left of B's x axis [deg]
  double pitch_deg = 0.0;                   ///< ... and below it [deg], in [-90, 90]
  double range_noise = 0.0;  ///< standard deviation of a range over the range, in [0, 0.5]
};

/// Throws std::invalid_argument naming the key, its value and the allowed range.
void Validate(const DepthCameraConfig& config);

estimation::CameraIntrinsics IntrinsicsOf(const DepthCameraConfig& config);

/// The camera's axes in B: rotation C to B.
Eigen::Matrix3d CameraAxes(const DepthCameraConfig& config);

/// Depth images by analytic ray casting of ground, obstacles and pad vehicle at its true pose. The
/// vehicle does not see itself. One DepthCamera belongs to one thread.
class DepthCamera {
 public:
  /// `seed` feeds the stream "depth camera". Throws std::invalid_argument naming the key, its value
  /// and the allowed range.
  DepthCamera(const DepthCameraConfig& config, const ObstacleField& obstacles,
              const PadGeometry& pad, std::uint64_t seed);

  /// Takes an image. `frame->depth` is resized to height x width if it has another size; else
  /// nothing is allocated.
  void Capture(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
               estimation::DepthFrame* frame);

  const DepthCameraConfig& config() const { return config_; }
  const Eigen::Matrix3d& R_BC() const { return R_BC_; }  ///< C to B
  const estimation::CameraIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  void Draw(const Eigen::Vector3d& p_WC, const Eigen::Matrix3d& R_WC,
            const estimation::PadState& pad);

  DepthCameraConfig config_;
  estimation::CameraIntrinsics intrinsics_;
  Eigen::Matrix3d R_BC_;
  PadGeometry pad_;
  ObstacleField obstacles_;
  std::vector<Eigen::Vector3d> rays_C_;  ///< per pixel, z = 1: a ray's parameter is its depth
  // Of the image at hand, in W and along the axis.
  std::vector<Eigen::Vector3d> rays_W_;
  std::vector<double> depth_;
  RandomStream noise_;
};

}  // namespace touchdown::sim
