// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include "sim/rendering/gl_context.h"

namespace touchdown::sim {

/// MuJoCo's handles of OpenGL objects, with a context of their own and an off-screen buffer of the size that the model's
/// visual/global says. Belongs to the thread that made it.
class GlScene {
 public:
  /// No flag of the drawing is set but that back faces are left out.
  /// @param more_geoms that may be added to the scene's own.
  /// @param font_scale mjFONTSCALE_50 ... mjFONTSCALE_300.
  /// Throws std::runtime_error if there is no off-screen rendering.
  GlScene(const mjModel& model, int more_geoms, int font_scale);
  GlScene(const GlScene&) = delete;
  GlScene& operator=(const GlScene&) = delete;
  ~GlScene();

  GlContext& context() { return context_; }
  mjvScene* scene() { return &scene_; }
  mjrContext* render() { return &render_; }

 private:
  void Free() noexcept;

  GlContext context_;
  mjvScene scene_{};
  mjrContext render_{};
};

}  // namespace touchdown::sim
