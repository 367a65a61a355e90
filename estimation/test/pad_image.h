// SPDX-License-Identifier: BSD-3-Clause
// A pad and a camera for tests, and the camera's images.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "estimation/tags/pad_tags.h"
#include "estimation/tags/tag_code.h"
#include "touchdown/estimation/base/gray_image.h"
#include "touchdown/estimation/tags/pad_pose.h"
#include "touchdown/estimation/tags/pad_reprojection.h"

namespace touchdown::estimation {

inline CameraIntrinsics TestCamera() { return {320, 240, 200.0, 160.0, 120.0}; }

/// The pad `distance` ahead, its normal `tilt` off the line to the camera, towards `direction`.
inline PoseCP PadAhead(double distance, double tilt, double direction, double yaw,
                       const Eigen::Vector2d& slope = {0.0, 0.0}) {
  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0.0);
  PoseCP pose;
  pose.p = distance * Eigen::Vector3d(slope.x(), slope.y(), 1.0);
  pose.R = (Eigen::AngleAxisd(tilt, axis) *
            Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))
               .toRotationMatrix();
  return pose;
}

inline Eigen::Vector2d Project(const PoseCP& pose, const CameraIntrinsics& camera,
                               const Eigen::Vector2d& x_P) {
  const Eigen::Vector3d x_C = pose.R * Eigen::Vector3d(x_P.x(), x_P.y(), 0.0) + pose.p;
  return camera.focal * x_C.head<2>() / x_C.z() + Eigen::Vector2d(camera.cx, camera.cy);
}

/// Exact detections of tags with these ids, or with Gaussian noise on each coordinate.
inline std::vector<TagDetection> Detections(const PoseCP& pose, const CameraIntrinsics& camera,
                                            const std::vector<int>& ids, double sigma = 0.0,
                                            std::mt19937_64* random = nullptr) {
  std::normal_distribution<double> normal;
  std::vector<TagDetection> tags;
  for (const int id : ids) {
    TagDetection tag;
    tag.id = id;
    const auto corners = PadTags()[static_cast<std::size_t>(id)].Corners();
    for (int k = 0; k < 4; ++k) {
      tag.corners.col(k) = Project(pose, camera, corners.col(k));
      if (random == nullptr) continue;
      tag.corners(0, k) += sigma * normal(*random);
      tag.corners(1, k) += sigma * normal(*random);
    }
    tags.push_back(tag);
  }
  return tags;
}

/// The true pose minus the one found, as PadPose::cov counts it.
inline Vector6d ErrorOf(const PoseCP& truth, const PadPose& found) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(truth.R * found.R_CP.transpose()));
  Vector6d error;
  error << truth.p - found.p_CP, turn.angle() * turn.axis();
  return error;
}

/// Grey level at a point of the pad: 0 to 255; white between the tags.
inline double PadLevel(const Eigen::Vector2d& x_P) {
  for (const PadTag& tag : PadTags()) {
    const double cell = tag.side / kTagBlackCells;
    const Eigen::Vector2d in_cells = (x_P - tag.center_P) / cell;
    const int column = static_cast<int>(std::floor(in_cells.x() + 0.5 * kTagCells));
    const int row = static_cast<int>(std::floor(0.5 * kTagCells - in_cells.y()));
    if (row < 0 || row >= kTagCells || column < 0 || column >= kTagCells) continue;
    static const std::vector<TagCode> codes = [] {
      std::vector<TagCode> all;
      for (int id = 0; id < kPadTagCount; ++id) all.push_back(TagCodeOf(id));
      return all;
    }();
    return codes[static_cast<std::size_t>(tag.id)][static_cast<std::size_t>(row)]
                [static_cast<std::size_t>(column)];
  }
  return 255.0;
}

/// The camera's image of the pad, each pixel the mean of 6 x 6 rays; grey beyond the sheet.
inline GrayImage DrawPad(const PoseCP& pose, const CameraIntrinsics& camera) {
  constexpr int kRays = 6;
  constexpr double kSheet = 0.64;  // [m]
  GrayImage image{camera.width, camera.height, {}};
  image.pixels.reserve(static_cast<std::size_t>(camera.width) * camera.height);
  const Eigen::Vector3d normal_C = pose.R.col(2);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      double sum = 0.0;
      for (int ray = 0; ray < kRays * kRays; ++ray) {
        const double x = u + (ray % kRays + 0.5) / kRays;
        const double y = v + (ray / kRays + 0.5) / kRays;
        const Eigen::Vector3d d((x - camera.cx) / camera.focal, (y - camera.cy) / camera.focal, 1);
        const Eigen::Vector3d hit = d * normal_C.dot(pose.p) / normal_C.dot(d);
        const Eigen::Vector2d x_P = (pose.R.transpose() * (hit - pose.p)).head<2>();
        sum += x_P.cwiseAbs().maxCoeff() < kSheet ? PadLevel(x_P) : 120.0;
      }
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(sum / (kRays * kRays))));
    }
  }
  return image;
}

}  // namespace touchdown::estimation
