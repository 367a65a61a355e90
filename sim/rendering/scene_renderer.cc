// SPDX-License-Identifier: BSD-3-Clause
// The depth buffer d in [0, 1] of a perspective projection with clipping planes n and f is
// z = n / (1 - d (1 - n / f)).

#include "sim/rendering/scene_renderer.h"

#include <limits>

#include "sim/rendering/ground_texture.h"
#include "sim/rendering/scene_stage.h"

namespace touchdown::sim {

class SceneRenderer::Impl {
 public:
  Impl(const VisualScene& scene, const ViewConfig& view)
      : stage_(scene, view, SceneMjcf(scene, view), GroundTexture(kGroundTexels), 16) {}

  void Render(const CameraPose& camera, const estimation::PadState& pad,
              std::vector<std::uint8_t>* rgb, std::vector<float>* depth) {
    stage_.Place(camera);
    stage_.Place(pad);
    stage_.Update();
    stage_.Draw(rgb, depth);
  }

  SceneStage stage_;
};

SceneRenderer::SceneRenderer(const VisualScene& scene, const ViewConfig& view)
    : impl_(std::make_unique<Impl>(scene, view)) {}
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;
SceneRenderer::~SceneRenderer() = default;

const estimation::CameraIntrinsics& SceneRenderer::intrinsics() const {
  return impl_->stage_.intrinsics();
}

void SceneRenderer::RenderColor(const CameraPose& camera, const estimation::PadState& pad,
                                std::vector<std::uint8_t>* rgb) {
  impl_->Render(camera, pad, rgb, nullptr);
}

void SceneRenderer::RenderDepth(const CameraPose& camera, const estimation::PadState& pad,
                                std::vector<float>* depth) {
  impl_->Render(camera, pad, nullptr, depth);
  const ViewConfig& view = impl_->stage_.view();
  const double slope = 1.0 - view.near / view.far;
  for (float& z : *depth) {
    z = z < 1.0F ? static_cast<float>(view.near / (1.0 - z * slope))
                 : std::numeric_limits<float>::infinity();
  }
}

}  // namespace touchdown::sim
