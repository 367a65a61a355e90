// SPDX-License-Identifier: BSD-3-Clause
// A model of the scene without dynamics: pad and camera are mocap bodies, their poses are set, the
// kinematics run and MuJoCo draws. Textures are filled between compiling and mjr_makeContext, which
// uploads them, so that no image file is needed. The depth buffer d in [0, 1] of a perspective
// projection with clipping planes n and f is z = n / (1 - d (1 - n / f)); rows come bottom-up.

#include "sim/rendering/scene_renderer.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"
#include "estimation/base/degrees.h"
#include "estimation/tags/pad_sheet.h"
#include "sim/mujoco/mujoco_call.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/rendering/gl_context.h"
#include "sim/rendering/ground_texture.h"

namespace touchdown::sim {
namespace {

void Check(const VisualScene& scene, const ViewConfig& view) {
  Validate(scene.pad, scene.deck_height);
  estimation::CheckWithin("pad.deck_half_size of a rendered pad", scene.pad.deck_half_size,
                          0.5 * estimation::kPadSheetSide, 5.0);
  estimation::CheckWithin("occlusion", scene.occlusion, 0.0, 0.95);
  estimation::CheckWithin("view.width", view.width, 1, 4096);
  estimation::CheckWithin("view.height", view.height, 1, 4096);
  estimation::CheckAbove("view.fov_y_deg", view.fov_y_deg, 0.0, 170.0);
  estimation::CheckWithin("view.near", view.near, 0.005, 1.0);
  estimation::CheckAbove("view.far", view.far, view.near, 1000.0);
}

void Fill(const char* name, const estimation::GrayImage& image, mjModel* model) {
  const int texture = mj_name2id(model, mjOBJ_TEXTURE, name);
  mjtByte* rgb = model->tex_rgb + model->tex_adr[texture];
  for (const std::uint8_t gray : image.pixels) rgb = std::fill_n(rgb, 3, gray);
}

// MuJoCo's handles of OpenGL objects.
class GlScene {
 public:
  explicit GlScene(const mjModel& model) {
    context_.MakeCurrent();
    mjv_defaultScene(&scene_);
    mjr_defaultContext(&render_);
    try {
      CallMujoco([&] { mjv_makeScene(&model, &scene_, model.ngeom + 16); });
      // The first call in a process looks up OpenGL's functions, into globals.
      static std::mutex one_at_a_time;
      const std::lock_guard<std::mutex> lock(one_at_a_time);
      CallMujoco([&] { mjr_makeContext(&model, &render_, mjFONTSCALE_50); });
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
  GlScene(const GlScene&) = delete;
  GlScene& operator=(const GlScene&) = delete;
  ~GlScene() { Free(); }

  GlContext& context() { return context_; }
  mjvScene* scene() { return &scene_; }
  mjrContext* render() { return &render_; }

 private:
  void Free() noexcept {
    try {
      context_.MakeCurrent();
      CallMujoco([&] { mjr_freeContext(&render_); });
    } catch (const std::runtime_error&) {
      // The context goes with all its objects.
    }
    mjv_freeScene(&scene_);
  }

  GlContext context_;
  mjvScene scene_{};
  mjrContext render_{};
};

MujocoModel CompileScene(const VisualScene& scene, const ViewConfig& view) {
  Check(scene, view);
  MujocoModel model = CompileMjcf(SceneMjcf(scene, view));
  Fill("ground", GroundTexture(kGroundTexels), model.get());
  Fill("pad", estimation::PadSheet(), model.get());
  return model;
}

template <typename T>
void FlipRows(int height, std::size_t row, std::vector<T>* image) {
  for (int top = 0, bottom = height - 1; top < bottom; ++top, --bottom) {
    const auto at = [&](int i) { return image->begin() + static_cast<std::ptrdiff_t>(row) * i; };
    std::swap_ranges(at(top), at(top + 1), at(bottom));
  }
}

}  // namespace

class SceneRenderer::Impl {
 public:
  Impl(const VisualScene& scene, const ViewConfig& view)
      : view_(view),
        model_(CompileScene(scene, view)),
        data_(MakeMujocoData(*model_)),
        gl_(*model_),
        pad_(MocapOf("pad")),
        camera_(MocapOf("camera")) {
    mjv_defaultOption(&option_);
    mjv_defaultCamera(&view_camera_);
    view_camera_.type = mjCAMERA_FIXED;
    view_camera_.fixedcamid = mj_name2id(model_.get(), mjOBJ_CAMERA, "camera");
    intrinsics_.width = view.width;
    intrinsics_.height = view.height;
    intrinsics_.focal =
        0.5 * view.height / std::tan(0.5 * estimation::Radians(view.fov_y_deg));
    intrinsics_.cx = 0.5 * view.width;
    intrinsics_.cy = 0.5 * view.height;
  }

  void Render(const CameraPose& camera, const estimation::PadState& pad, std::uint8_t* rgb,
              float* depth) {
    // MuJoCo's camera looks along its -z, its y axis is up.
    const Eigen::Quaterniond q_WC(camera.R_WC * Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal());
    const Eigen::Quaterniond q_WP(Eigen::AngleAxisd(pad.yaw, Eigen::Vector3d::UnitZ()));
    Place(camera_, camera.p_WC, q_WC);
    Place(pad_, pad.p_WP, q_WP);
    gl_.context().MakeCurrent();
    const mjrRect viewport = {0, 0, view_.width, view_.height};
    CallMujoco([&] {
      mj_kinematics(model_.get(), data_.get());
      mj_comPos(model_.get(), data_.get());
      mj_camlight(model_.get(), data_.get());
      mjv_updateScene(model_.get(), data_.get(), &option_, nullptr, &view_camera_, mjCAT_ALL,
                      gl_.scene());
      mjr_render(viewport, gl_.scene(), gl_.render());
      mjr_readPixels(rgb, depth, viewport, gl_.render());
    });
  }

  ViewConfig view_;
  estimation::CameraIntrinsics intrinsics_;

 private:
  int MocapOf(const char* body) const {
    return model_->body_mocapid[mj_name2id(model_.get(), mjOBJ_BODY, body)];
  }

  void Place(int mocap, const Eigen::Vector3d& p, const Eigen::Quaterniond& q) {
    std::copy_n(p.data(), 3, data_->mocap_pos + 3 * mocap);
    mjtNum* const wxyz = data_->mocap_quat + 4 * mocap;
    wxyz[0] = q.w();
    std::copy_n(q.vec().data(), 3, wxyz + 1);
  }

  MujocoModel model_;
  MujocoData data_;
  GlScene gl_;
  int pad_;
  int camera_;
  mjvOption option_{};
  mjvCamera view_camera_{};
};

SceneRenderer::SceneRenderer(const VisualScene& scene, const ViewConfig& view)
    : impl_(std::make_unique<Impl>(scene, view)) {}
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;
SceneRenderer::~SceneRenderer() = default;

const estimation::CameraIntrinsics& SceneRenderer::intrinsics() const { return impl_->intrinsics_; }

void SceneRenderer::RenderColor(const CameraPose& camera, const estimation::PadState& pad,
                                std::vector<std::uint8_t>* rgb) {
  const ViewConfig& view = impl_->view_;
  const std::size_t row = 3 * static_cast<std::size_t>(view.width);
  rgb->resize(row * static_cast<std::size_t>(view.height));
  impl_->Render(camera, pad, rgb->data(), nullptr);
  FlipRows(view.height, row, rgb);
}

void SceneRenderer::RenderDepth(const CameraPose& camera, const estimation::PadState& pad,
                                std::vector<float>* depth) {
  const ViewConfig& view = impl_->view_;
  const std::size_t row = static_cast<std::size_t>(view.width);
  depth->resize(row * static_cast<std::size_t>(view.height));
  impl_->Render(camera, pad, nullptr, depth->data());
  FlipRows(view.height, row, depth);
  const double slope = 1.0 - view.near / view.far;
  for (float& z : *depth) {
    z = z < 1.0F ? static_cast<float>(view.near / (1.0 - z * slope))
                 : std::numeric_limits<float>::infinity();
  }
}

}  // namespace touchdown::sim
