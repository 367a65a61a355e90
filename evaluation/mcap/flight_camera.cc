// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/flight_camera.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/flight/depth_sensor.h"
#include "evaluation/flight/pad_sensor.h"
#include "evaluation/mcap/flight_scene.h"
#include "evaluation/mcap/message_parts.h"

namespace touchdown::evaluation {
namespace {

constexpr double kMostGrayBytes = 1.0e6, kMostDepthBytes = 0.4e6;  // a second

// Of a grey pixel as a PNG: little more than half a byte with the noise that cameras have, all of it with much noise.
double GrayBytes(const Scenario& scenario) { return scenario.camera.noise > 2.0 ? 1.0 : 0.6; }

double RateOf(double camera_rate, double most_bytes, double pixel_bytes, int width, int height) {
  return std::min(camera_rate, most_bytes / (pixel_bytes * width * height));
}

sim::VisualScene WithoutPlate(sim::VisualScene scene) {
  scene.occlusion = 0.0;
  return scene;
}

std::string PngOf(const estimation::GrayImage& image) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_GRAY;
  png_alloc_size_t length = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(length, '\0');
  if (png_image_write_to_memory(&png, bytes.data(), &length, 0, image.pixels.data(), 0, nullptr) ==
      0) {
    throw std::runtime_error(fmt::format("an image could not be made a PNG: {}", png.message));
  }
  bytes.resize(length);
  return bytes;
}

std::string CalibrationOf(double t, const char* frame, const estimation::CameraIntrinsics& camera) {
  // The format has the middle of the first pixel at 0, we have its corner there.
  const double f = camera.focal, cx = camera.cx - 0.5, cy = camera.cy - 0.5;
  const double D[] = {0.0, 0.0, 0.0, 0.0, 0.0};
  const double K[] = {f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0};
  const double R[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const double P[] = {f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  std::string bytes;
  protozero::pbf_writer calibration(bytes);
  AddTime(&calibration, 1, t);
  calibration.add_fixed32(2, static_cast<std::uint32_t>(camera.width));
  calibration.add_fixed32(3, static_cast<std::uint32_t>(camera.height));
  calibration.add_string(4, "plumb_bob");
  calibration.add_packed_double(5, std::begin(D), std::end(D));
  calibration.add_packed_double(6, std::begin(K), std::end(K));
  calibration.add_packed_double(7, std::begin(R), std::end(R));
  calibration.add_packed_double(8, std::begin(P), std::end(P));
  calibration.add_string(9, frame);
  return bytes;
}

}  // namespace

Eigen::Isometry3d DownCameraPose(const Scenario& scenario) {
  return PoseOf(PadCameraOf(scenario).p_BC, Eigen::Quaterniond(sim::DownwardCameraAxes()));
}

Eigen::Isometry3d DepthCameraPose(const Scenario& scenario) {
  const sim::DepthCameraConfig config = DepthCamerasOf(scenario).front().config;
  return PoseOf(config.p_BC, Eigen::Quaterniond(sim::CameraAxes(config)));
}

FlightCameras::FlightCameras(const Scenario& scenario, const sim::VisualScene& scene)
    : down_(PadCameraOf(scenario), scene, scenario.seed),
      depth_(DepthCamerasOf(scenario).front().config, WithoutPlate(scene), scenario.seed),
      down_rate_(RateOf(scenario.tag_rate, kMostGrayBytes, GrayBytes(scenario),
                        scenario.camera.width, scenario.camera.height)),
      depth_rate_(RateOf(DepthCamerasOf(scenario).front().rate, kMostDepthBytes,
                         sizeof(std::uint16_t), scenario.depth.width, scenario.depth.height)) {}

std::string FlightCameras::DownImage(const TrackSample& now) {
  down_.Capture(now.vehicle, now.pad, &gray_);
  std::string bytes;
  protozero::pbf_writer image(bytes);
  AddTime(&image, 1, now.vehicle.t);
  image.add_bytes(2, PngOf(gray_));
  image.add_string(3, "png");
  image.add_string(4, kDownFrame);
  return bytes;
}

std::string FlightCameras::DepthImage(const TrackSample& now) {
  constexpr double kMost = 65535.0;  // [mm]
  depth_.Capture(now.vehicle, now.pad, &frame_);
  std::string data;
  data.reserve(2 * frame_.depth.size());
  for (const float depth : frame_.depth) {
    const double mm = std::isfinite(depth) ? std::round(1e3 * static_cast<double>(depth)) : 0.0;
    const auto pixel = static_cast<std::uint16_t>(mm > kMost ? 0.0 : mm);
    data.push_back(static_cast<char>(pixel & 0xFFU));
    data.push_back(static_cast<char>(pixel >> 8U));
  }
  std::string bytes;
  protozero::pbf_writer image(bytes);
  const auto width = static_cast<std::uint32_t>(frame_.intrinsics.width);
  AddTime(&image, 1, now.vehicle.t);
  image.add_fixed32(2, width);
  image.add_fixed32(3, static_cast<std::uint32_t>(frame_.intrinsics.height));
  image.add_string(4, "16UC1");
  image.add_fixed32(5, 2 * width);  // bytes of a row
  image.add_bytes(6, data);
  image.add_string(7, kDepthFrame);
  return bytes;
}

std::string FlightCameras::DownCalibration(double t) const {
  return CalibrationOf(t, kDownFrame, down_.intrinsics());
}

std::string FlightCameras::DepthCalibration(double t) const {
  return CalibrationOf(t, kDepthFrame, depth_.intrinsics());
}

}  // namespace touchdown::evaluation
