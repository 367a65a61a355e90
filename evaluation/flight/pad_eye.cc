// SPDX-License-Identifier: BSD-3-Clause
// An image without the pad takes the finder longest, and far from the pad all are such. So an image
// is searched only if a ball about the expected pad, large enough for the sheet and for five
// standard deviations of the expectation and half a metre, reaches into the camera's pyramid of
// view, and is not so far away that no tag can be read. Against an expectation that is wrong and does
// not know it, every tenth image is searched all the same. Images that are not searched are rendered
// nevertheless: the noise of the next ones stays what it was.

#include "evaluation/flight/pad_eye.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "estimation/tags/pad_sheet.h"
#include "estimation/tags/pad_tags.h"
#include "sim/sensors/pad_camera.h"
#include "sim/sensors/tag_sensor.h"
#include "touchdown/estimation/tags/pad_finder.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

constexpr double kAttitudeSigma = 1.0 * std::numbers::pi / 180.0;  // claimed [rad]
constexpr double kMargin = 0.5;                                    // about the expected pad [m]
constexpr double kSigmas = 5.0;                                    // of its position
constexpr int kMostPassedOver = 9;     // images in a row that are not searched
constexpr double kLeastTagPixels = 4;  // half a pixel to a cell: far below what is ever read

class FastPadEye final : public PadEye {
 public:
  FastPadEye(const Scenario& scenario, const sim::WorldConfig& world, std::uint64_t seed)
      : PadEye(scenario, seed), tags_(ConfigOf(scenario), world.obstacles, seed) {}

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

  std::optional<estimation::PadSighting> Sight(const estimation::VehicleState& vehicle,
                                               const estimation::VehicleState& believed,
                                               const estimation::PadState& pad,
                                               const estimation::PadFilter& /*expected*/,
                                               SensingTimes* times) override {
    std::optional<estimation::PadSighting> sighting;
    solvers::AddThreadCpu(&times->pad_finding,
                          [&] { sighting = tags_.Sight(vehicle.t, vehicle, pad, believed.q_WB); });
    return sighting;
  }

  sim::TagSensor tags_;
};

class RenderedPadEye final : public PadEye {
 public:
  RenderedPadEye(const Scenario& scenario, const sim::WorldConfig& world, std::uint64_t seed,
                 bool thrifty)
      : PadEye(scenario, seed),
        camera_(ConfigOf(scenario), SceneOf(scenario, world), seed),
        thrifty_(thrifty) {}

 private:
  static sim::PadCameraConfig ConfigOf(const Scenario& scenario) {
    sim::PadCameraConfig config;
    config.width = scenario.camera.width;
    config.height = scenario.camera.height;
    config.fov_y_deg = scenario.camera.fov_deg;
    config.noise_sigma = scenario.camera.noise;
    config.exposure_ms = scenario.camera.exposure_ms;
    return config;
  }

  static sim::VisualScene SceneOf(const Scenario& scenario, const sim::WorldConfig& world) {
    sim::VisualScene scene;
    scene.obstacles = world.obstacles;
    scene.pad = world.pad;
    scene.deck_height = scenario.pad.deck_height;
    scene.occlusion = scenario.camera.occlusion;
    return scene;
  }

  std::optional<estimation::PadSighting> Sight(const estimation::VehicleState& vehicle,
                                               const estimation::VehicleState& believed,
                                               const estimation::PadState& pad,
                                               const estimation::PadFilter& expected,
                                               SensingTimes* times) override {
    const double begin = solvers::ThreadCpuSeconds();
    camera_.Capture(vehicle, pad, &image_);
    const double taken = solvers::ThreadCpuSeconds();
    times->pad_image += taken - begin;
    if (PassOver(believed, expected)) return std::nullopt;
    const Eigen::Matrix3d R_BC = sim::DownwardCameraAxes();
    const estimation::PadView view = finder_.Find(
        image_.View(), camera_.intrinsics(),
        estimation::LevelPadNormal(believed.q_WB.toRotationMatrix(), R_BC, kAttitudeSigma));
    times->pad_finding += solvers::ThreadCpuSeconds() - taken;
    if (view.pose.status != estimation::PadPoseStatus::kSolved) return std::nullopt;
    estimation::PadSighting sighting =
        estimation::ToSighting(view.pose, vehicle.t, R_BC, camera_.config().p_BC);
    sighting.tags_seen = static_cast<int>(view.tags.size());
    return sighting;
  }

  bool PassOver(const estimation::VehicleState& believed, const estimation::PadFilter& expected) {
    const bool search = !thrifty_ || passed_over_ == kMostPassedOver || !expected.initialized() ||
                        MayShow(believed, expected);
    passed_over_ = search ? 0 : passed_over_ + 1;
    return !search;
  }

  bool MayShow(const estimation::VehicleState& believed,
               const estimation::PadFilter& expected) const {
    const Eigen::Vector3d p_BP =
        believed.q_WB.conjugate() * (expected.Estimate(believed.t).p_WP - believed.p_WB);
    const Eigen::Vector3d p_C =
        sim::DownwardCameraAxes().transpose() * (p_BP - camera_.config().p_BC);
    const double radius = estimation::kPadSheetSide * std::sqrt(0.5) + kMargin +
                          kSigmas * expected.PositionSigma(believed.t);
    return MayShowPad(p_C, radius, camera_.intrinsics());
  }

  sim::PadCamera camera_;
  estimation::PadFinder finder_;
  estimation::GrayImage image_;
  bool thrifty_;
  int passed_over_ = 0;
};

}  // namespace

PadEye::PadEye(const Scenario& scenario, std::uint64_t seed)
    : clock_(scenario.tag_rate),
      delivery_({scenario.camera.latency_ms, scenario.camera.drop}, seed, "pad camera delivery") {}

void PadEye::Look(const estimation::VehicleState& vehicle, const estimation::VehicleState& believed,
                  const estimation::PadState& pad, const estimation::PadFilter& expected,
                  SensingTimes* times) {
  if (!clock_.Due(vehicle.t) || !delivery_.Admit()) return;
  if (const auto sighting = Sight(vehicle, believed, pad, expected, times)) {
    delivery_.Hold(vehicle.t, *sighting);
  }
}

bool MayShowPad(const Eigen::Vector3d& p_C, double radius,
                const estimation::CameraIntrinsics& camera) {
  double largest = 0.0;  // side of a tag [m]
  for (const estimation::PadTag& tag : estimation::PadTags()) {
    const Eigen::Matrix<double, 2, 4> corners = tag.Corners();
    largest = std::max(largest, (corners.col(1) - corners.col(0)).norm());
  }
  if (p_C.norm() - radius > camera.focal * largest / kLeastTagPixels) return false;
  // How far outside a side of the pyramid of view, each a plane through the camera.
  const auto beyond = [&](double across, double half_size) {
    return (std::abs(across) * camera.focal - p_C.z() * half_size) /
           std::hypot(camera.focal, half_size);
  };
  return beyond(p_C.x(), 0.5 * camera.width) <= radius &&
         beyond(p_C.y(), 0.5 * camera.height) <= radius;
}

std::unique_ptr<PadEye> MakePadEye(const Scenario& scenario, const sim::WorldConfig& world,
                                   std::uint64_t seed, bool thrifty) {
  if (scenario.sensing == SensingKind::kFast) {
    return std::make_unique<FastPadEye>(scenario, world, seed);
  }
  return std::make_unique<RenderedPadEye>(scenario, world, seed, thrifty);
}

}  // namespace touchdown::evaluation
