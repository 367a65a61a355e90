// SPDX-License-Identifier: BSD-3-Clause
// Depth images from the renderer's depth buffer. They differ from exact rays in three things. The
// buffer has steps (0.1 mm at 6 m with the near plane at 20 mm). Cylinders have facets. A pixel at
// an edge may belong to the other side. Nothing nearer than the near plane is seen.

#include "sim/sensors/rendered_depth_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace touchdown::sim {
namespace {

ViewConfig ViewOf(const DepthCameraConfig& config) {
  Validate(config);
  ViewConfig view;
  view.width = config.width;
  view.height = config.height;
  const double tangent = 0.5 * config.height / IntrinsicsOf(config).focal;
  view.fov_y_deg = 2.0 * std::atan(tangent) * 180.0 / std::numbers::pi;
  view.far = 1.01 * config.max_range + view.near;
  return view;
}

}  // namespace

RenderedDepthCamera::RenderedDepthCamera(const DepthCameraConfig& config, const VisualScene& scene,
                                         std::uint64_t seed)
    : config_(config),
      intrinsics_(IntrinsicsOf(config)),
      R_BC_(CameraAxes(config)),
      renderer_(scene, ViewOf(config)),
      noise_(seed, "rendered depth camera") {}

void RenderedDepthCamera::Capture(const estimation::VehicleState& vehicle,
                                  const estimation::PadState& pad, estimation::DepthFrame* frame) {
  const Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
  frame->t = vehicle.t;
  frame->intrinsics = intrinsics_;
  frame->R_WC = R_WB * R_BC_;
  frame->p_WC = vehicle.p_WB + R_WB * config_.p_BC;
  frame->max_range = config_.max_range;
  renderer_.RenderDepth({frame->p_WC, frame->R_WC}, pad, &frame->depth);

  const double range_squared = config_.max_range * config_.max_range;
  std::size_t i = 0;
  for (int row = 0; row < intrinsics_.height; ++row) {
    const double v = (row + 0.5 - intrinsics_.cy) / intrinsics_.focal;
    for (int column = 0; column < intrinsics_.width; ++column, ++i) {
      const double u = (column + 0.5 - intrinsics_.cx) / intrinsics_.focal;
      double depth = frame->depth[i];
      const bool seen = depth * depth * (1.0 + u * u + v * v) <= range_squared;
      if (seen && config_.range_noise > 0.0) {
        depth = std::max(0.0, depth * (1.0 + noise_.Normal(config_.range_noise)));
      }
      frame->depth[i] = seen ? static_cast<float>(depth) : std::numeric_limits<float>::infinity();
    }
  }
}

}  // namespace touchdown::sim
