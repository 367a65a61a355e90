// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/gl_scene.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>

#include "sim/mujoco/mujoco_call.h"

namespace touchdown::sim {

GlScene::GlScene(const mjModel& model, int more_geoms, int font_scale) {
  context_.MakeCurrent();
  mjv_defaultScene(&scene_);
  mjr_defaultContext(&render_);
  try {
    CallMujoco([&] { mjv_makeScene(&model, &scene_, model.ngeom + more_geoms); });
    // The first call in a process looks up OpenGL's functions, into globals.
    static std::mutex one_at_a_time;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    CallMujoco([&] { mjr_makeContext(&model, &render_, font_scale); });
  } catch (...) {
    Free();
    throw;
  }
  mjr_setBuffer(mjFB_OFFSCREEN, &render_);
  if (render_.currentBuffer != mjFB_OFFSCREEN) {
    Free();
    throw std::runtime_error("MuJoCo has no off-screen buffer to draw into.");
  }
  std::fill_n(scene_.flags, static_cast<int>(mjNRNDFLAG), mjtByte{0});
  scene_.flags[mjRND_CULL_FACE] = 1;
}

GlScene::~GlScene() { Free(); }

void GlScene::Free() noexcept {
  try {
    context_.MakeCurrent();
    CallMujoco([&] { mjr_freeContext(&render_); });
  } catch (const std::runtime_error&) {
    // The context goes with all its objects.
  }
  mjv_freeScene(&scene_);
}

}  // namespace touchdown::sim
