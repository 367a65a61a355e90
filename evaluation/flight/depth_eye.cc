// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/depth_eye.h"

#include "sim/sensors/rendered_depth_camera.h"
#include "touchdown/planning/replan/stage_timer.h"

namespace touchdown::evaluation {
namespace {

/// Of sim::DepthCamera or sim::RenderedDepthCamera.
template <typename Camera>
class CameraDepthEye final : public DepthEye {
 public:
  CameraDepthEye(const Scenario& scenario, std::uint64_t seed, Camera camera)
      : DepthEye(scenario, seed), camera_(std::move(camera)) {}

 private:
  void Capture(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
               estimation::DepthImage* image) override {
    frame_.depth.swap(image->depth);
    camera_.Capture(vehicle, pad, &frame_);
    frame_.depth.swap(image->depth);
    image->t = frame_.t;
    image->intrinsics = frame_.intrinsics;
    image->max_range = frame_.max_range;
    image->p_BC = camera_.config().p_BC;
    image->R_BC = camera_.R_BC();
  }

  Camera camera_;
  estimation::DepthFrame frame_;
};

}  // namespace

sim::DepthCameraConfig DepthCameraOf(const Scenario& scenario) {
  sim::DepthCameraConfig config;
  config.width = scenario.depth.width;
  config.height = scenario.depth.height;
  config.max_range = scenario.depth.range;
  config.range_noise = scenario.depth.noise;
  return config;
}

DepthEye::DepthEye(const Scenario& scenario, std::uint64_t seed)
    : clock_(scenario.depth_rate),
      delivery_({scenario.depth.latency_ms, scenario.depth.drop}, seed, "depth camera delivery") {}

void DepthEye::Look(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
                    SensingTimes* times) {
  if (!clock_.Due(vehicle.t) || !delivery_.Admit()) return;
  DepthGlimpse glimpse = std::move(spare_);
  glimpse.sense = planning::StageTimes::Span{"sense"};
  {
    const planning::StageTimer timer(&glimpse.sense);
    Capture(vehicle, pad, &glimpse.image);
  }
  times->depth_image += glimpse.sense.cpu;
  delivery_.Hold(vehicle.t, std::move(glimpse));
}

std::unique_ptr<DepthEye> MakeDepthEye(const Scenario& scenario, const sim::WorldConfig& world,
                                       std::uint64_t seed) {
  const sim::DepthCameraConfig config = DepthCameraOf(scenario);
  if (scenario.sensing == SensingKind::kFast) {
    return std::make_unique<CameraDepthEye<sim::DepthCamera>>(
        scenario, seed, sim::DepthCamera(config, world.obstacles, world.pad, seed));
  }
  sim::VisualScene scene;
  scene.obstacles = world.obstacles;
  scene.pad = world.pad;
  scene.deck_height = scenario.pad.deck_height;
  return std::make_unique<CameraDepthEye<sim::RenderedDepthCamera>>(
      scenario, seed, sim::RenderedDepthCamera(config, scene, seed));
}

}  // namespace touchdown::evaluation
