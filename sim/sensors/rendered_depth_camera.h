// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/base/random_stream.h"
#include "sim/rendering/scene_renderer.h"
#include "sim/sensors/depth_camera.h"

namespace touchdown::sim {

/// The camera of DepthCamera, its images rendered instead of cast ray by ray. Belongs to the thread
/// that made it.
class RenderedDepthCamera {
 public:
  /// `seed` feeds the stream "rendered depth camera". Throws as DepthCamera and SceneRenderer do.
  RenderedDepthCamera(const DepthCameraConfig& config, const VisualScene& scene,
                      std::uint64_t seed);

  /// As DepthCamera::Capture; the renderer's library may allocate.
  void Capture(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
               estimation::DepthFrame* frame);

  const DepthCameraConfig& config() const { return config_; }
  const Eigen::Matrix3d& R_BC() const { return R_BC_; }  ///< C to B
  const estimation::CameraIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  DepthCameraConfig config_;
  estimation::CameraIntrinsics intrinsics_;
  Eigen::Matrix3d R_BC_;
  SceneRenderer renderer_;
  RandomStream noise_;
};

}  // namespace touchdown::sim
