// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "sim/rendering/scene_mjcf.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

/// Images of a scene, rendered by MuJoCo in memory, without display or GPU: ground, obstacles, and
/// the pad with its markers. The vehicle is not drawn: its own cameras do not see it. The same input
/// gives the same bits. One SceneRenderer belongs to the thread that made it; any number of them can
/// run side by side. Making one takes half a second.
class SceneRenderer {
 public:
  /// Throws std::invalid_argument naming thing, value and allowed range, std::runtime_error if
  /// there is no off-screen rendering.
  SceneRenderer(const VisualScene& scene, const ViewConfig& view);
  SceneRenderer(SceneRenderer&&) noexcept;
  SceneRenderer& operator=(SceneRenderer&&) noexcept;
  ~SceneRenderer();

  /// @param rgb height x width x 3, row-major, row 0 at the top. It is resized if it has another
  /// size. The renderer's library may allocate.
  void RenderColor(const CameraPose& camera, const estimation::PadState& pad,
                   std::vector<std::uint8_t>* rgb);

  /// @param depth height x width, along the optical axis [m], inf beyond the far plane.
  void RenderDepth(const CameraPose& camera, const estimation::PadState& pad,
                   std::vector<float>* depth);

  const estimation::CameraIntrinsics& intrinsics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::sim
