// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/base/random_stream.h"
#include "sim/rendering/scene_renderer.h"
#include "sim/sensors/downward_camera.h"
#include "touchdown/estimation/base/gray_image.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

/// Downward camera, with the axes of DownwardCameraAxes.
struct PadCameraConfig {
  int width = 320;                           ///< [pixel], in [8, 4096]
  int height = 240;                          ///< [pixel], in [8, 4096]
  double fov_y_deg = 90.0;                   ///< vertical field of view [deg], in (0, 170]
  Eigen::Vector3d p_BC = {0.0, 0.0, -0.05};  ///< camera in B [m]
  double noise_sigma = 2.0;                  ///< of each pixel [grey level], in [0, 100]
  double exposure_ms = 0.0;                  ///< in [0, 100]; 0: nothing is blurred
  int max_subframes = 8;                     ///< rendered for one exposure at most, in [1, 64]
};

/// Grey images of the pad camera, rendered. Belongs to the thread that made it.
class PadCamera {
 public:
  /// `seed` feeds the stream "pad camera". Throws std::invalid_argument naming key, value, range,
  /// std::runtime_error if there is no off-screen rendering.
  PadCamera(const PadCameraConfig& config, const VisualScene& scene, std::uint64_t seed);

  /// Takes an image. The states are those in the middle of the exposure, which is the image's time
  /// stamp. Before and after it everything moves at its velocity and angular rate. `image` is
  /// resized if it has another size.
  void Capture(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
               estimation::GrayImage* image);

  const PadCameraConfig& config() const { return config_; }
  const estimation::CameraIntrinsics& intrinsics() const { return renderer_.intrinsics(); }

 private:
  int Subframes(const estimation::VehicleState& vehicle, const estimation::PadState& pad) const;

  PadCameraConfig config_;
  SceneRenderer renderer_;
  RandomStream noise_;
  std::vector<std::uint8_t> rgb_;
  std::vector<float> sum_;  ///< of the subframes' grey levels
};

}  // namespace touchdown::sim
