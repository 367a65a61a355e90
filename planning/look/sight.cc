// SPDX-License-Identifier: BSD-3-Clause
#include "planning/look/sight.h"

#include <cmath>

#include <Eigen/Geometry>

#include "planning/map/voxel_traversal.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {
namespace {

constexpr double kInside = 0.08;  // of the image's edge: the heading's error and more [rad]

Eigen::Matrix3d Hovering(double yaw, const Eigen::Vector3d& pull_W) {
  const Eigen::Vector3d up = estimation::kGravity * Eigen::Vector3d::UnitZ() - pull_W;
  return (Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up) *
          Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

}  // namespace

Sight::Sight(const LookCamera& camera, const Viewpoint& from, const Eigen::Vector3d& pull_W)
    : reach_(camera.reach) {
  const Eigen::Matrix3d R_WB = Hovering(from.yaw, pull_W);
  R_CW_ = (R_WB * camera.R_BC).transpose();
  p_WC_ = from.p_WB + R_WB * camera.p_BC;
  const estimation::CameraIntrinsics& k = camera.intrinsics;
  const auto edge = [&k](double pixel, double centre, double inwards) {
    return std::tan(std::atan((pixel - centre) / k.focal) + inwards);
  };
  low_ = {edge(0.0, k.cx, kInside), edge(0.0, k.cy, kInside)};
  high_ = {edge(k.width, k.cx, -kInside), edge(k.height, k.cy, -kInside)};
}

bool Sight::Reaches(const CellIndex& cell, const OccupancyMap& map) const {
  return TraverseCells(p_WC_, map.CentreOf(cell), map.resolution(),
                       [&](const CellIndex& at) { return at == cell || !map.IsOccupied(at); });
}

}  // namespace touchdown::planning
