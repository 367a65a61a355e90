// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/depth_sensor.h"

#include "sim/sensors/rendered_depth_camera.h"
#include "touchdown/planning/replan/stage_timer.h"

namespace touchdown::evaluation {
namespace {

/// Of sim::DepthCamera or sim::RenderedDepthCamera.
template <typename Camera>
class CameraDepthSensor final : public DepthSensor {
 public:
  CameraDepthSensor(const Scenario& scenario, std::uint64_t seed, Camera camera)
      : DepthSensor(scenario, seed), camera_(std::move(camera)) {}

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

DepthSensor::DepthSensor(const Scenario& scenario, std::uint64_t seed)
    : clock_(scenario.depth_rate),
      delivery_({scenario.depth.latency_ms, scenario.depth.drop, scenario.depth.outage[0],
                 scenario.depth.outage[1]},
                seed, "depth camera delivery") {}

void DepthSensor::Look(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
                       SensingTimes* times) {
  if (!clock_.Due(vehicle.t) || !delivery_.Admit(vehicle.t)) return;
  TimedDepthImage timed = std::move(spare_);
  timed.sense = planning::StageTimes::Span{"sense"};
  {
    const planning::StageTimer timer(&timed.sense);
    Capture(vehicle, pad, &timed.image);
  }
  times->depth_image += timed.sense.cpu;
  delivery_.Hold(vehicle.t, std::move(timed));
}

std::unique_ptr<DepthSensor> MakeDepthSensor(const Scenario& scenario,
                                             const sim::WorldConfig& world, std::uint64_t seed) {
  const sim::DepthCameraConfig config = DepthCameraOf(scenario);
  if (scenario.sensing == SensingKind::kFast) {
    return std::make_unique<CameraDepthSensor<sim::DepthCamera>>(
        scenario, seed, sim::DepthCamera(config, world.obstacles, world.pad, seed));
  }
  sim::VisualScene scene;
  scene.obstacles = world.obstacles;
  scene.pad = world.pad;
  scene.deck_height = scenario.pad.deck_height;
  return std::make_unique<CameraDepthSensor<sim::RenderedDepthCamera>>(
      scenario, seed, sim::RenderedDepthCamera(config, scene, seed));
}

}  // namespace touchdown::evaluation
