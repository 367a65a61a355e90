// SPDX-License-Identifier: BSD-3-Clause
// Pad and camera are mocap bodies, their poses are set, the kinematics run and MuJoCo draws.
// Textures are filled between compiling and mjr_makeContext, which uploads them, so that no image
// file is needed. Rows come bottom-up.

#include "sim/rendering/scene_stage.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/base/argument_check.h"
#include "estimation/base/degrees.h"
#include "estimation/tags/pad_sheet.h"
#include "sim/mujoco/mujoco_call.h"

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

MujocoModel Compile(const VisualScene& scene, const ViewConfig& view, const std::string& mjcf,
                    const estimation::GrayImage& ground) {
  Check(scene, view);
  MujocoModel model = CompileMjcf(mjcf);
  Fill("ground", ground, model.get());
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

SceneStage::SceneStage(const VisualScene& scene, const ViewConfig& view, const std::string& mjcf,
                       const estimation::GrayImage& ground, int more_geoms)
    : view_(view),
      model_(Compile(scene, view, mjcf, ground)),
      data_(MakeMujocoData(*model_)),
      gl_(*model_, more_geoms, mjFONTSCALE_50) {
  mjv_defaultOption(&option_);
  mjv_defaultCamera(&camera_);
  camera_.type = mjCAMERA_FIXED;
  camera_.fixedcamid = mj_name2id(model_.get(), mjOBJ_CAMERA, "camera");
  intrinsics_.width = view.width;
  intrinsics_.height = view.height;
  intrinsics_.focal = 0.5 * view.height / std::tan(0.5 * estimation::Radians(view.fov_y_deg));
  intrinsics_.cx = 0.5 * view.width;
  intrinsics_.cy = 0.5 * view.height;
}

void SceneStage::Place(const char* name, const Eigen::Vector3d& p_W,
                       const Eigen::Quaterniond& q_W) {
  const int body = mj_name2id(model_.get(), mjOBJ_BODY, name);
  const int mocap = body < 0 ? -1 : model_->body_mocapid[body];
  if (mocap < 0) throw std::invalid_argument(std::string(name) + " is no mocap body of the scene");
  std::copy_n(p_W.data(), 3, data_->mocap_pos + 3 * mocap);
  mjtNum* const wxyz = data_->mocap_quat + 4 * mocap;
  wxyz[0] = q_W.w();
  std::copy_n(q_W.vec().data(), 3, wxyz + 1);
}

void SceneStage::Place(const CameraPose& camera) {
  // MuJoCo's camera looks along its -z, its y axis is up.
  Place("camera", camera.p_WC,
        Eigen::Quaterniond(camera.R_WC * Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal()));
}

void SceneStage::Place(const estimation::PadState& pad) {
  Place("pad", pad.p_WP, Eigen::Quaterniond(Eigen::AngleAxisd(pad.yaw, Eigen::Vector3d::UnitZ())));
}

mjvScene* SceneStage::Update() {
  CallMujoco([&] {
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_camlight(model_.get(), data_.get());
    mjv_updateScene(model_.get(), data_.get(), &option_, nullptr, &camera_, mjCAT_ALL, gl_.scene());
  });
  return gl_.scene();
}

void SceneStage::Draw(std::vector<std::uint8_t>* rgb, std::vector<float>* depth) {
  const std::size_t width = static_cast<std::size_t>(view_.width);
  const std::size_t height = static_cast<std::size_t>(view_.height);
  if (rgb != nullptr) rgb->resize(3 * width * height);
  if (depth != nullptr) depth->resize(width * height);
  gl_.context().MakeCurrent();
  const mjrRect viewport = {0, 0, view_.width, view_.height};
  CallMujoco([&] {
    mjr_render(viewport, gl_.scene(), gl_.render());
    mjr_readPixels(rgb == nullptr ? nullptr : rgb->data(),
                   depth == nullptr ? nullptr : depth->data(), viewport, gl_.render());
  });
  if (rgb != nullptr) FlipRows(view_.height, 3 * width, rgb);
  if (depth != nullptr) FlipRows(view_.height, width, depth);
}

}  // namespace touchdown::sim
