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
  CameraDepthSensor(const Scenario& scenario, double rate, std::uint64_t seed, Camera camera)
      : DepthSensor(scenario, rate, seed), camera_(std::move(camera)) {}

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

std::vector<MountedDepthCamera> DepthCamerasOf(const Scenario& scenario) {
  MountedDepthCamera nose;
  nose.config.width = scenario.depth.width;
  nose.config.height = scenario.depth.height;
  nose.config.max_range = scenario.depth.range;
  nose.config.range_noise = scenario.depth.noise;
  nose.rate = scenario.depth_rate;
  if (scenario.depth.cameras.empty()) return {nose};
  std::vector<MountedDepthCamera> cameras;
  for (const DepthMount& mount : scenario.depth.cameras) {
    MountedDepthCamera& camera = cameras.emplace_back(nose);
    camera.config.p_BC = mount.position;
    camera.config.yaw_deg = mount.yaw_deg;
    camera.config.pitch_deg = mount.pitch_deg;
    camera.config.fov_x_deg = mount.fov_deg;
    camera.rate = mount.rate;
  }
  return cameras;
}

DepthSensor::DepthSensor(const Scenario& scenario, double rate, std::uint64_t seed)
    : clock_(rate),
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

std::vector<std::unique_ptr<DepthSensor>> MakeDepthSensors(const Scenario& scenario,
                                                           const sim::WorldConfig& world,
                                                           std::uint64_t seed) {
  std::vector<std::unique_ptr<DepthSensor>> sensors;
  for (const MountedDepthCamera& camera : DepthCamerasOf(scenario)) {
    const std::uint64_t own_seed = seed + sensors.size();  // each has noise and losses of its own
    if (scenario.sensing == SensingKind::kFast) {
      sensors.push_back(std::make_unique<CameraDepthSensor<sim::DepthCamera>>(
          scenario, camera.rate, own_seed,
          sim::DepthCamera(camera.config, world.obstacles, world.pad, own_seed)));
    } else {
      sim::VisualScene scene;
      scene.obstacles = world.obstacles;
      scene.pad = world.pad;
      scene.deck_height = scenario.pad.deck_height;
      sensors.push_back(std::make_unique<CameraDepthSensor<sim::RenderedDepthCamera>>(
          scenario, camera.rate, own_seed,
          sim::RenderedDepthCamera(camera.config, scene, own_seed)));
    }
  }
  return sensors;
}

}  // namespace touchdown::evaluation
