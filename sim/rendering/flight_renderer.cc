// SPDX-License-Identifier: BSD-3-Clause
// A line is a chain of slim boxes: they cost a tenth of MuJoCo's capsules. They shine by themselves, so
// that they are seen in shadows, too.

#include "sim/rendering/flight_renderer.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sim/rendering/flight_scene_mjcf.h"
#include "sim/rendering/ground_texture.h"
#include "sim/rendering/scene_stage.h"

namespace touchdown::sim {
namespace {

// Most of a line's colour is its own light; the reflected light is added.
constexpr float kReflect = 0.55F;
constexpr double kSunHeight = 30.0;  // of the shadow map's origin above what is looked at [m]
constexpr double kSunStep = 2.0;     // by which it moves on, so that shadows' edges stand still [m]
constexpr double kSunAhead = 9.0;    // of what it is centred on, before the camera [m]
constexpr double kWidest = 0.008;    // a line, over its distance from the camera
constexpr double kShortest = 1e-6;   // piece of a line [m]

// The cameras' ground is rich in contrast, for them. This one is pale, with lines every metre to see how fast things move.
estimation::GrayImage LightGround() {
  constexpr int kLines = 4, kLineTexels = 2;
  estimation::GrayImage ground = GroundTexture(kGroundTexels);
  for (int i = 0; i < kGroundTexels; ++i) {
    for (int j = 0; j < kGroundTexels; ++j) {
      std::uint8_t& level = ground.pixels[static_cast<std::size_t>(i * kGroundTexels + j)];
      const int period = kGroundTexels / kLines;
      const bool line = i % period < kLineTexels || j % period < kLineTexels;
      level = static_cast<std::uint8_t>((line ? 168 : 138) + level / 5);
    }
  }
  return ground;
}

void AddGeom(int type, const Eigen::Vector3d& size, const Eigen::Vector3d& p_W,
             const Eigen::Matrix3d& R, const std::array<float, 4>& rgba, mjvScene* scene) {
  if (scene->ngeom >= scene->maxgeom) return;
  mjvGeom* const geom = scene->geoms + scene->ngeom++;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = R;
  const float color[] = {kReflect * rgba[0], kReflect * rgba[1], kReflect * rgba[2], rgba[3]};
  mjv_initGeom(geom, type, size.data(), p_W.data(), rows.data(), color);
  geom->category = mjCAT_DECOR;
  geom->emission = 1.0F;
  geom->specular = 0.0F;
}

void AddPiece(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const FlightLine& line,
              const Eigen::Vector3d& p_WC, mjvScene* scene) {
  const double length = (b - a).norm();
  if (!(length > kShortest)) return;
  const Eigen::Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), b - a).toRotationMatrix();
  const Eigen::Vector3d middle = 0.5 * (a + b);
  const double half = 0.5 * std::min(line.width, kWidest * (middle - p_WC).norm());
  AddGeom(mjGEOM_BOX, {0.5 * length + 0.5 * half, half, half}, middle, R, line.rgba, scene);
}

// The shadow map's middle follows the view; the sun's rays stay as they are.
void MoveSun(const CameraPose& camera, mjvScene* scene) {
  const Eigen::Vector3d ahead = camera.p_WC + kSunAhead * camera.R_WC.col(2);
  for (int i = 0; i < scene->nlight; ++i) {
    mjvLight& light = scene->lights[i];
    if (light.castshadow == 0) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const double shift = -light.dir[axis] / light.dir[2] * kSunHeight;
      light.pos[axis] = static_cast<float>(kSunStep * std::round(ahead[axis] / kSunStep) - shift);
    }
    light.pos[2] = static_cast<float>(kSunHeight);
  }
}

}  // namespace

class FlightRenderer::Impl {
 public:
  Impl(const VisualScene& scene, const std::string& vehicle_mjcf, const ViewConfig& view)
      : stage_(scene, view, FlightSceneMjcf(scene, vehicle_mjcf, view), LightGround(),
               kMostPieces) {}

  void Render(const FlightMoment& moment, std::vector<std::uint8_t>* rgb) {
    stage_.Place(moment.camera);
    stage_.Place(moment.pad);
    stage_.Place("vehicle", moment.vehicle.p_WB, moment.vehicle.q_WB);
    mjvScene* const scene = stage_.Update();
    for (const int flag : {mjRND_SHADOW, mjRND_SKYBOX, mjRND_FOG}) scene->flags[flag] = 1;
    MoveSun(moment.camera, scene);
    for (const FlightMark& mark : moment.marks) {
      AddGeom(mjGEOM_SPHERE, Eigen::Vector3d::Constant(mark.radius), mark.p_W,
              Eigen::Matrix3d::Identity(), mark.rgba, scene);
    }
    for (const FlightLine& line : moment.lines) {
      for (std::size_t i = 1; i < line.points_W.size(); ++i) {
        AddPiece(line.points_W[i - 1], line.points_W[i], line, moment.camera.p_WC, scene);
      }
    }
    stage_.Draw(rgb, nullptr);
  }

  SceneStage stage_;
};

FlightRenderer::FlightRenderer(const VisualScene& scene, const std::string& vehicle_mjcf,
                               const ViewConfig& view)
    : impl_(std::make_unique<Impl>(scene, vehicle_mjcf, view)) {}
FlightRenderer::FlightRenderer(FlightRenderer&&) noexcept = default;
FlightRenderer& FlightRenderer::operator=(FlightRenderer&&) noexcept = default;
FlightRenderer::~FlightRenderer() = default;

void FlightRenderer::Render(const FlightMoment& moment, std::vector<std::uint8_t>* rgb) {
  impl_->Render(moment, rgb);
}

const estimation::CameraIntrinsics& FlightRenderer::intrinsics() const {
  return impl_->stage_.intrinsics();
}

}  // namespace touchdown::sim
