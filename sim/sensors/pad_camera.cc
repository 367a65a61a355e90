// SPDX-License-Identifier: BSD-3-Clause
// Grey images: ITU-R BT.601 luma of the rendered colours. Motion blur is the mean of subframes evenly spread over the
// exposure, one for each pixel that the image moves in it. Then follow Gaussian noise and rounding to 8 bits.

#include "sim/sensors/pad_camera.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

constexpr double kMinRange = 0.1;  // for the guess of the blur [m]

ViewConfig ViewOf(const PadCameraConfig& config) {
  estimation::CheckWithin("pad_camera.width", config.width, 8, 4096);
  estimation::CheckWithin("pad_camera.height", config.height, 8, 4096);
  estimation::CheckAbove("pad_camera.fov_y_deg", config.fov_y_deg, 0.0, 170.0);
  estimation::CheckWithin("pad_camera.noise_sigma", config.noise_sigma, 0.0, 100.0);
  estimation::CheckWithin("pad_camera.exposure_ms", config.exposure_ms, 0.0, 100.0);
  estimation::CheckWithin("pad_camera.max_subframes", config.max_subframes, 1, 64);
  estimation::CheckWithin("length of pad_camera.p_BC", config.p_BC.norm(), 0.0, 10.0);
  ViewConfig view;
  view.width = config.width;
  view.height = config.height;
  view.fov_y_deg = config.fov_y_deg;
  return view;
}

CameraPose PoseAt(double dt, const estimation::VehicleState& vehicle, const Eigen::Vector3d& p_BC) {
  const Eigen::Vector3d turn = dt * vehicle.w_WB_B;
  Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
  if (turn.norm() > 0.0) R_WB = R_WB * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return {vehicle.p_WB + dt * vehicle.v_WB + R_WB * p_BC, R_WB * DownwardCameraAxes()};
}

}  // namespace

PadCamera::PadCamera(const PadCameraConfig& config, const VisualScene& scene, std::uint64_t seed)
    : config_(config), renderer_(scene, ViewOf(config)), noise_(seed, "pad camera") {}

int PadCamera::Subframes(const estimation::VehicleState& vehicle,
                         const estimation::PadState& pad) const {
  const double range = std::max((vehicle.p_WB - pad.p_WP).norm(), kMinRange);
  const double rate = vehicle.w_WB_B.norm() + std::abs(pad.yaw_rate) +
                      (vehicle.v_WB - pad.v_WP).norm() / range;  // [rad/s]
  const double pixels = 1e-3 * config_.exposure_ms * rate * intrinsics().focal;
  return std::clamp(static_cast<int>(std::ceil(std::min(pixels, 1e3))), 1, config_.max_subframes);
}

void PadCamera::Capture(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
                        estimation::GrayImage* image) {
  const std::size_t pixels =
      static_cast<std::size_t>(config_.width) * static_cast<std::size_t>(config_.height);
  const int subframes = Subframes(vehicle, pad);
  sum_.assign(pixels, 0.0F);
  for (int k = 0; k < subframes; ++k) {
    const double dt = 1e-3 * config_.exposure_ms * ((k + 0.5) / subframes - 0.5);
    estimation::PadState moved = pad;
    moved.p_WP += dt * pad.v_WP;
    moved.yaw += dt * pad.yaw_rate;
    renderer_.RenderColor(PoseAt(dt, vehicle, config_.p_BC), moved, &rgb_);
    for (std::size_t i = 0; i < pixels; ++i) {
      sum_[i] += 0.299F * rgb_[3 * i] + 0.587F * rgb_[3 * i + 1] + 0.114F * rgb_[3 * i + 2];
    }
  }
  image->width = config_.width;
  image->height = config_.height;
  image->pixels.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    double level = sum_[i] / subframes;
    if (config_.noise_sigma > 0.0) level += noise_.Normal(config_.noise_sigma);
    image->pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
  }
}

}  // namespace touchdown::sim
