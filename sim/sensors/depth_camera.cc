// SPDX-License-Identifier: BSD-3-Clause
// Depth images by casting rays, one per pixel centre, at the shapes themselves. Each shape (for a mesh, each triangle)
// is tested only with the rays of the pixels that its corners, or its bounds, enclose in the image. With 10^5 triangles
// this costs a tenth of a search along each ray. Rays have z_C = 1, so a ray's parameter is the depth.

#include "sim/sensors/depth_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "estimation/base/argument_check.h"
#include "estimation/base/degrees.h"
#include "sim/obstacles/ray_intersection.h"

namespace touchdown::sim {
namespace {

/// Pixels [low, high) of an image.
struct PixelBlock {
  Eigen::Array2i low, high;
};

/// The pixels in whose direction a convex hull of points may be, given in the camera's frame [m].
template <std::size_t kCount>
PixelBlock PixelsOf(const std::array<Eigen::Vector3d, kCount>& points_C,
                    const estimation::CameraIntrinsics& k) {
  constexpr double kNear = 1e-6, kRounding = 1e-6;  // [m], [pixel]
  Eigen::Array2d low = Eigen::Array2d::Constant(1e15), high = -low;
  const auto enclose = [&](const Eigen::Vector3d& p) {
    const Eigen::Array2d pixel = k.focal * p.head<2>().array() / p.z() + Eigen::Array2d(k.cx, k.cy);
    low = low.min(pixel);
    high = high.max(pixel);
  };
  for (const Eigen::Vector3d& p : points_C) {
    if (p.z() >= kNear) {
      enclose(p);
      continue;
    }
    for (const Eigen::Vector3d& q : points_C) {  // of what passes the camera, the part in front
      if (q.z() > kNear) enclose(p + (kNear - p.z()) / (q.z() - p.z()) * (q - p));
    }
  }
  const Eigen::Array2d last = Eigen::Array2i(k.width, k.height).cast<double>();
  // A pixel's centre is half a pixel from its number.
  return {(low - 0.5 - kRounding).max(0.0).min(last).ceil().cast<int>(),
          (high + 0.5 + kRounding).max(0.0).min(last).floor().cast<int>()};
}

}  // namespace

void Validate(const DepthCameraConfig& config) {
  estimation::CheckWithin("depth_camera.width", config.width, 1, 4096);
  estimation::CheckWithin("depth_camera.height", config.height, 1, 4096);
  estimation::CheckAbove("depth_camera.fov_x_deg", config.fov_x_deg, 0.0, 170.0);
  estimation::CheckAbove("depth_camera.max_range", config.max_range, 0.0, 100.0);
  estimation::CheckWithin("depth_camera.yaw_deg", config.yaw_deg, -180.0, 180.0);
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
  const double yaw = estimation::Radians(config.yaw_deg);
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * R_BC;
}

DepthCamera::DepthCamera(const DepthCameraConfig& config, const ObstacleField& obstacles,
                         const PadGeometry& pad, std::uint64_t seed)
    : config_(config), pad_(pad), obstacles_(obstacles), noise_(seed, "depth camera") {
  Validate(config);
  intrinsics_ = IntrinsicsOf(config);
  R_BC_ = CameraAxes(config);

  const std::size_t pixels = static_cast<std::size_t>(config.width) * config.height;
  rays_C_.reserve(pixels);
  depth_.resize(pixels);
  rays_W_.resize(pixels);
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
  for (std::size_t i = 0; i < rays_C_.size(); ++i) {
    rays_W_[i] = frame->R_WC * rays_C_[i];
    // The ground is seen from above only.
    const double to_ground = -frame->p_WC.z() / rays_W_[i].z();
    depth_[i] = rays_W_[i].z() < 0.0 && to_ground >= 0.0 ? to_ground : kInfinity;
  }
  Draw(frame->p_WC, frame->R_WC, pad);
  for (std::size_t i = 0; i < rays_C_.size(); ++i) {
    double depth = depth_[i];
    const bool seen =
        depth * depth * rays_C_[i].squaredNorm() <= config_.max_range * config_.max_range;
    if (seen && config_.range_noise > 0.0) {
      depth = std::max(0.0, depth * (1.0 + noise_.Normal(config_.range_noise)));
    }
    frame->depth[i] = static_cast<float>(seen ? depth : kInfinity);
  }
}

void DepthCamera::Draw(const Eigen::Vector3d& p_WC, const Eigen::Matrix3d& R_WC,
                       const estimation::PadState& pad) {
  const Eigen::Matrix3d R_CW = R_WC.transpose();
  const auto meet = [&](const PixelBlock& block, const auto& ray_distance) {
    for (int row = block.low.y(); row < block.high.y(); ++row) {
      for (int column = block.low.x(); column < block.high.x(); ++column) {
        const auto i = static_cast<std::size_t>(row * intrinsics_.width + column);
        depth_[i] = std::min(depth_[i], ray_distance(rays_W_[i]));
      }
    }
  };
  const auto block_of = [&](const Bounds& bounds) {
    std::array<Eigen::Vector3d, 8> corners_C;
    for (std::size_t i = 0; i < 8; ++i) {
      corners_C[i] = R_CW * (Eigen::Vector3d((i & 1) != 0 ? bounds.max.x() : bounds.min.x(),
                                             (i & 2) != 0 ? bounds.max.y() : bounds.min.y(),
                                             (i & 4) != 0 ? bounds.max.z() : bounds.min.z()) -
                             p_WC);
    }
    return PixelsOf(corners_C, intrinsics_);
  };
  const Bounds in_range{p_WC.array() - config_.max_range, p_WC.array() + config_.max_range};
  obstacles_.tree().Within(in_range, [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    const Obstacle& obstacle = obstacles_.obstacles()[i];
    const auto* const mesh = std::get_if<Mesh>(&obstacle);
    if (mesh == nullptr) {
      meet(block_of(BoundsOf(obstacle)), [&](const Eigen::Vector3d& ray_W) {
        return obstacles_.RayDistance(i, p_WC, ray_W);
      });
      return;
    }
    mesh->surface->Within(in_range, [&](const Triangle& triangle) {
      const Eigen::Vector3d a_C = R_CW * (triangle.a - p_WC);
      const Eigen::Vector3d b_C = a_C + R_CW * triangle.ab, c_C = a_C + R_CW * triangle.ac;
      meet(PixelsOf<3>({a_C, b_C, c_C}, intrinsics_), [&](const Eigen::Vector3d& ray_W) {
        return RayTriangle(triangle, p_WC, ray_W);
      });
    });
  });
  for (const Box& box : {DeckBox(pad_, pad), PadBodyBox(pad_, pad)}) {
    const TurnedBox turned(box);
    meet(block_of(BoundsOf(box)),
         [&](const Eigen::Vector3d& ray_W) { return turned.RayDistance(p_WC, ray_W); });
  }
}

}  // namespace touchdown::sim
