// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/pad_sensor.h"

#include <utility>

#include "sim/sensors/tag_sensor.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

class FastPadSensor final : public PadSensor {
 public:
  FastPadSensor(const Scenario& scenario, const sim::WorldConfig& world, std::uint64_t seed)
      : PadSensor(scenario, seed), tags_(ConfigOf(scenario), world.obstacles, seed) {}

 private:
  static sim::TagSensorConfig ConfigOf(const Scenario& scenario) {
    sim::TagSensorConfig config;
    config.rate_hz = scenario.tag_rate;
    config.width = scenario.camera.width;
    config.height = scenario.camera.height;
    config.fov_y_deg = scenario.camera.fov_deg;
    config.occlusion = scenario.camera.occlusion;
    return config;
  }

  std::optional<PadSeen> See(const estimation::VehicleState& vehicle,
                             const estimation::VehicleState& believed,
                             const estimation::PadState& pad, SensingTimes* times) override {
    std::optional<estimation::PadSighting> sighting;
    solvers::AddThreadCpu(&times->pad_finding,
                          [&] { sighting = tags_.Sight(vehicle.t, vehicle, pad, believed.q_WB); });
    if (!sighting) return std::nullopt;
    return PadSeen{nullptr, *sighting};
  }

  sim::TagSensor tags_;
};

class RenderedPadSensor final : public PadSensor {
 public:
  RenderedPadSensor(const Scenario& scenario, const sim::WorldConfig& world, std::uint64_t seed)
      : PadSensor(scenario, seed),
        camera_(PadCameraOf(scenario), VisualSceneOf(scenario, world), seed) {}

 private:
  std::optional<PadSeen> See(const estimation::VehicleState& vehicle,
                             const estimation::VehicleState& /*believed*/,
                             const estimation::PadState& pad, SensingTimes* times) override {
    auto image = std::make_unique<estimation::PadImage>();
    image->t = vehicle.t;
    image->intrinsics = camera_.intrinsics();
    image->p_BC = camera_.config().p_BC;
    image->R_BC = sim::DownwardCameraAxes();
    solvers::AddThreadCpu(&times->pad_image, [&] { camera_.Capture(vehicle, pad, &image->gray); });
    return PadSeen{std::move(image), {}};
  }

  sim::PadCamera camera_;
};

}  // namespace

sim::PadCameraConfig PadCameraOf(const Scenario& scenario) {
  sim::PadCameraConfig config;
  config.width = scenario.camera.width;
  config.height = scenario.camera.height;
  config.fov_y_deg = scenario.camera.fov_deg;
  config.noise_sigma = scenario.camera.noise;
  config.exposure_ms = scenario.camera.exposure_ms;
  return config;
}

sim::VisualScene VisualSceneOf(const Scenario& scenario, const sim::WorldConfig& world) {
  sim::VisualScene scene;
  scene.obstacles = world.obstacles;
  scene.pad = world.pad;
  scene.deck_height = scenario.pad.deck_height;
  scene.occlusion = scenario.camera.occlusion;
  return scene;
}

PadSensor::PadSensor(const Scenario& scenario, std::uint64_t seed)
    : clock_(scenario.tag_rate),
      delivery_({scenario.camera.latency_ms, scenario.camera.drop, scenario.camera.outage[0],
                 scenario.camera.outage[1]},
                seed, "pad camera delivery") {}

void PadSensor::Look(const estimation::VehicleState& vehicle,
                     const estimation::VehicleState& believed, const estimation::PadState& pad,
                     SensingTimes* times) {
  if (!clock_.Due(vehicle.t) || !delivery_.Admit(vehicle.t)) return;
  if (auto seen = See(vehicle, believed, pad, times)) {
    delivery_.Hold(vehicle.t, std::move(*seen));
  }
}

std::unique_ptr<PadSensor> MakePadSensor(const Scenario& scenario, const sim::WorldConfig& world,
                                         std::uint64_t seed) {
  if (scenario.sensing == SensingKind::kFast) {
    return std::make_unique<FastPadSensor>(scenario, world, seed);
  }
  return std::make_unique<RenderedPadSensor>(scenario, world, seed);
}

}  // namespace touchdown::evaluation
