// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sim/mujoco/mujoco_model.h"
#include "sim/rendering/gl_scene.h"
#include "sim/rendering/scene_mjcf.h"
#include "touchdown/estimation/base/gray_image.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

/// A model of a scene without dynamics, and its renderer. Bodies with mocap are placed, then the scene is drawn.
/// Belongs to the thread that made it.
class SceneStage {
 public:
  /// @param mjcf of `scene`, with bodies "pad" and "camera" as in SceneMjcf. @param ground its texture, kGroundTexels a side.
  /// @param more_geoms as of GlScene.
  /// Throws std::invalid_argument naming thing, value and allowed range, std::runtime_error if
  /// there is no off-screen rendering.
  SceneStage(const VisualScene& scene, const ViewConfig& view, const std::string& mjcf,
             const estimation::GrayImage& ground, int more_geoms);

  /// Places a body with mocap. Throws std::invalid_argument if the model has none of this name.
  void Place(const char* body, const Eigen::Vector3d& p_W, const Eigen::Quaterniond& q_W);
  void Place(const CameraPose& camera);
  void Place(const estimation::PadState& pad);

  /// Makes MuJoCo's list of drawn geoms at the current poses. The list can be changed until Draw.
  mjvScene* Update();

  /// Draws it. @param rgb height x width x 3, nullptr: not wanted. @param depth MuJoCo's depth buffer, height x width;
  /// nullptr: not wanted. Row 0 at the top; both are resized.
  void Draw(std::vector<std::uint8_t>* rgb, std::vector<float>* depth);

  const ViewConfig& view() const { return view_; }
  const estimation::CameraIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  ViewConfig view_;
  estimation::CameraIntrinsics intrinsics_;
  MujocoModel model_;
  MujocoData data_;
  GlScene gl_;
  mjvOption option_{};
  mjvCamera camera_{};
};

}  // namespace touchdown::sim
