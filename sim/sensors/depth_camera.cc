// SPDX-License-Identifier: BSD-3-Clause
// Depth images by casting one ray per pixel centre at the shapes themselves, which at 80x60 pixels costs a tenth of
// mj_ray and of rendering. Rays have z_C = 1, so that a ray's parameter is the depth.

#include "sim/sensors/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "estimation/base/argument_check.h"
#include "estimation/base/degrees.h"
#include "sim/obstacles/ray_intersection.h"

namespace touchdown::sim {
namespace {

constexpr double kBeyond = 1.001;  // of the range: what is farther is not looked for

}  // namespace

void Validate(const DepthCameraConfig& config) {
  estimation::CheckWithin("depth_camera.width", config.width, 1, 4096);
  estimation::CheckWithin("depth_camera.height", config.height, 1, 4096);
  estimation::CheckAbove("depth_camera.fov_x_deg", config.fov_x_deg, 0.0, 170.0);
  estimation::CheckAbove("depth_camera.max_range", config.max_range, 0.0, 100.0);
  estimation::CheckWithin("depth_camera.pitch_deg", config.pitch_deg, -90.0, 90.0);
  estimation::CheckWithin("depth_camera.range_noise", config.range_noise, 0.0, 0.5);
  estimation::CheckWithin("length of depth_camera.p_BC", config.p_BC.norm(), 0.0, 10.0);
}

estimation::CameraIntrinsics IntrinsicsOf(const DepthCameraConfig& config) {
  estimation::CameraIntrinsics intrinsics;
  intrinsics.width = config.width;
  intrinsics.height = config.height;
  intrinsics.focal = 0.5 * config.width / std::tan(0.5 * estimation::Radians(config.fov_x_deg));
  intrinsics.cx = 0.5 * config.width;
  intrinsics.cy = 0.5 * config.height;
  return intrinsics;
}

Eigen::Matrix3d CameraAxes(const DepthCameraConfig& config) {
  const double c = std::cos(estimation::Radians(config.pitch_deg));
  const double s = std::sin(estimation::Radians(config.pitch_deg));
  Eigen::Matrix3d R_BC;
  R_BC.col(0) = -Eigen::Vector3d::UnitY();
  R_BC.col(1) = Eigen::Vector3d(-s, 0.0, -c);
  R_BC.col(2) = Eigen::Vector3d(c, 0.0, -s);
  return R_BC;
}

DepthCamera::DepthCamera(const DepthCameraConfig& config, const ObstacleField& obstacles,
                         const PadGeometry& pad, std::uint64_t seed)
    : config_(config), pad_(pad), obstacles_(obstacles), noise_(seed, "depth camera") {
  Validate(config);
  intrinsics_ = IntrinsicsOf(config);
  R_BC_ = CameraAxes(config);

  rays_C_.reserve(static_cast<std::size_t>(config.width) * config.height);
  for (int row = 0; row < config.height; ++row) {
    for (int column = 0; column < config.width; ++column) {
      rays_C_.emplace_back((column + 0.5 - intrinsics_.cx) / intrinsics_.focal,
                           (row + 0.5 - intrinsics_.cy) / intrinsics_.focal, 1.0);
    }
  }
}

void DepthCamera::Capture(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
                          estimation::DepthFrame* frame) {
  const Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
  frame->t = vehicle.t;
  frame->intrinsics = intrinsics_;
  frame->R_WC = R_WB * R_BC_;
  frame->p_WC = vehicle.p_WB + R_WB * config_.p_BC;
  frame->max_range = config_.max_range;
  frame->depth.resize(rays_C_.size());
  const TurnedBox deck(DeckBox(pad_, pad)), body(PadBodyBox(pad_, pad));

  for (std::size_t i = 0; i < rays_C_.size(); ++i) {
    const Eigen::Vector3d ray_W = frame->R_WC * rays_C_[i];
    const double ray_squared = rays_C_[i].squaredNorm();
    // The ground is seen from above only.
    const double to_ground = -frame->p_WC.z() / ray_W.z();
    double depth = ray_W.z() < 0.0 && to_ground >= 0.0 ? to_ground : kInfinity;
    depth = std::min({depth, deck.RayDistance(frame->p_WC, ray_W),
                      body.RayDistance(frame->p_WC, ray_W)});
    const double beyond = kBeyond * config_.max_range / std::sqrt(ray_squared);
    depth = obstacles_.RayDistance(frame->p_WC, ray_W, std::min(depth, beyond));
    const bool seen = depth * depth * ray_squared <= config_.max_range * config_.max_range;
    if (seen && config_.range_noise > 0.0) {
      depth = std::max(0.0, depth * (1.0 + noise_.Normal(config_.range_noise)));
    }
    frame->depth[i] = static_cast<float>(seen ? depth : kInfinity);
  }
}

}  // namespace touchdown::sim
