// SPDX-License-Identifier: BSD-3-Clause
// Measurement model of the pad camera, with the constants of TagModel, which are fitted to rendered
// images. The tags' true corners are projected; a tag is found by a probit of its size. There are
// two cases. If the sheet is small enough in the image for estimation::PadAlignment, all tags with
// their centre in the image count. They count found or not, with a small noise of the corners.
// Otherwise only the found tags count, with the noise of tag corners. The pose is solved from these
// corners by the same solver that rendered images use.

#include "sim/sensors/tag_sensor.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "estimation/base/argument_check.h"
#include "estimation/base/degrees.h"
#include "estimation/tags/pad_sheet.h"
#include "sim/pad/pad_geometry.h"
#include "sim/sensors/downward_camera.h"
#include "touchdown/estimation/tags/pad_alignment.h"

namespace touchdown::sim {
namespace {

using Corners = Eigen::Matrix<double, 2, 4>;

constexpr double kMinSigma = 1e-6;  // for the solver, if corners are exact [pixel]

// The pad in C.
struct Placement {
  Eigen::Vector3d p_CP;
  Eigen::Matrix3d R_CP;

  Placement(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
            const Eigen::Vector3d& p_BC) {
    const Eigen::Matrix3d R_BW = vehicle.q_WB.toRotationMatrix().transpose();
    const Eigen::Matrix3d R_CB = DownwardCameraAxes().transpose();
    p_CP = R_CB * (R_BW * (pad.p_WP - vehicle.p_WB) - p_BC);
    R_CP = R_CB * R_BW * Eigen::AngleAxisd(pad.yaw, Eigen::Vector3d::UnitZ());
  }
  Eigen::Vector3d ToC(const Eigen::Vector2d& x_P) const {
    return p_CP + R_CP * Eigen::Vector3d(x_P.x(), x_P.y(), 0.0);
  }
};

Eigen::Vector2d Project(const estimation::CameraIntrinsics& camera, const Eigen::Vector3d& x_C) {
  return camera.focal * x_C.head<2>() / x_C.z() + Eigen::Vector2d(camera.cx, camera.cy);
}

bool InImage(const estimation::CameraIntrinsics& camera, const Eigen::Vector3d& x_C) {
  if (x_C.z() <= 0.0) return false;
  const Eigen::Vector2d pixel = Project(camera, x_C);
  return pixel.minCoeff() >= 0.0 && pixel.x() <= camera.width && pixel.y() <= camera.height;
}

Corners CornersOf(const estimation::PadTag& tag, const Placement& placement,
                  const estimation::CameraIntrinsics& camera) {
  Corners corners = tag.Corners();
  for (int k = 0; k < 4; ++k) corners.col(k) = Project(camera, placement.ToC(corners.col(k)));
  return corners;
}

double ShortestSide(const Corners& corners) {
  double shortest = (corners.col(3) - corners.col(0)).norm();
  for (int k = 0; k < 3; ++k) {
    shortest = std::min(shortest, (corners.col(k + 1) - corners.col(k)).norm());
  }
  return shortest;
}

// As PadAlignment decides: all of the sheet is before the camera, and its area is not above a
// limit.
bool SheetIsAligned(const Placement& placement, const estimation::CameraIntrinsics& camera) {
  constexpr double kHalf = 0.5 * estimation::kPadSheetSide;
  constexpr double kMinDepth = 0.05;  // [m]
  Eigen::Vector2d low(camera.width, camera.height);
  Eigen::Vector2d high(0.0, 0.0);
  for (const double x : {-kHalf, kHalf}) {
    for (const double y : {-kHalf, kHalf}) {
      const Eigen::Vector3d x_C = placement.ToC({x, y});
      if (x_C.z() <= kMinDepth) return false;
      const Eigen::Vector2d pixel = Project(camera, x_C)
                                        .cwiseMax(Eigen::Vector2d::Zero())
                                        .cwiseMin(Eigen::Vector2d(camera.width, camera.height));
      low = low.cwiseMin(pixel);
      high = high.cwiseMax(pixel);
    }
  }
  return (high - low).prod() <= estimation::PadAlignmentOptions{}.max_pixels;
}

}  // namespace

TagSensor::TagSensor(const TagSensorConfig& config, const ObstacleField& obstacles,
                     std::uint64_t seed)
    : config_(config), obstacles_(obstacles), clock_(config.rate_hz), noise_(seed, "tag camera") {
  estimation::CheckWithin("tag_camera.width", config.width, 1, 4096);
  estimation::CheckWithin("tag_camera.height", config.height, 1, 4096);
  estimation::CheckAbove("tag_camera.fov_y_deg", config.fov_y_deg, 0.0, 170.0);
  estimation::CheckWithin("tag_camera.max_view_angle_deg", config.max_view_angle_deg, 0.0, 89.0);
  estimation::CheckWithin("tag_camera.attitude_sigma_deg", config.attitude_sigma_deg, 0.01, 45.0);
  estimation::CheckWithin("tag_camera.noise_scale", config.noise_scale, 0.0, 100.0);
  estimation::CheckWithin("tag_camera.occlusion", config.occlusion, 0.0, 0.95);
  estimation::CheckAbove("tag_camera.model.spread", config.model.spread, 0.0, 1000.0);
  estimation::CheckWithin("length of tag_camera.p_BC", config.p_BC.norm(), 0.0, 10.0);
  intrinsics_.width = config.width;
  intrinsics_.height = config.height;
  intrinsics_.focal = 0.5 * config.height / std::tan(0.5 * estimation::Radians(config.fov_y_deg));
  intrinsics_.cx = 0.5 * config.width;
  intrinsics_.cy = 0.5 * config.height;
}

std::array<bool, estimation::kPadTagCount> TagSensor::Visible(
    const estimation::VehicleState& vehicle, const estimation::PadState& pad) const {
  const Placement placement(vehicle, pad, config_.p_BC);
  const Eigen::Vector3d p_WC = vehicle.p_WB + vehicle.q_WB * config_.p_BC;
  const Eigen::Matrix3d R_WC = vehicle.q_WB.toRotationMatrix() * DownwardCameraAxes();
  const double plate_edge = PlateEdge(config_.occlusion);
  const double cos_limit = std::cos(estimation::Radians(config_.max_view_angle_deg));
  const auto corner_seen = [&](const Eigen::Vector3d& corner_C) {
    return InImage(intrinsics_, corner_C) &&
           // Of the ray from camera (0) to corner (1), nothing may cross before 1.
           obstacles_.RayDistance(p_WC, R_WC * corner_C) >= 1.0;
  };
  std::array<bool, estimation::kPadTagCount> visible{};
  for (const estimation::PadTag& tag : estimation::PadTags()) {
    const Eigen::Vector3d center_C = placement.ToC(tag.center_P);
    if (-placement.R_CP.col(2).dot(center_C) < cos_limit * center_C.norm()) continue;
    const Corners corners = tag.Corners();
    bool all = config_.occlusion == 0.0 || corners.row(0).maxCoeff() < plate_edge;
    for (int k = 0; k < 4 && all; ++k) all = corner_seen(placement.ToC(corners.col(k)));
    visible[static_cast<std::size_t>(tag.id)] = all;
  }
  return visible;
}

TagSensor::Image TagSensor::Look(const estimation::VehicleState& vehicle,
                                 const estimation::PadState& pad,
                                 const Eigen::Quaterniond& believed) {
  const TagModel& model = config_.model;
  const std::array<bool, estimation::kPadTagCount> visible = Visible(vehicle, pad);
  Image image;
  if (std::none_of(visible.begin(), visible.end(), [](bool one) { return one; })) return image;
  const Placement placement(vehicle, pad, config_.p_BC);
  std::array<Corners, estimation::kPadTagCount> corners;
  std::array<bool, estimation::kPadTagCount> in_sheet{};
  double largest = 0.0;
  bool any = false;
  for (const estimation::PadTag& tag : estimation::PadTags()) {
    const auto id = static_cast<std::size_t>(tag.id);
    const double luck = noise_.Normal(1.0);
    // All of the sheet in the image counts, whole tags or not.
    in_sheet[id] = InImage(intrinsics_, placement.ToC(tag.center_P));
    if (!visible[id] && !in_sheet[id]) continue;
    corners[id] = CornersOf(tag, placement, intrinsics_);
    if (!visible[id]) continue;
    const double size = ShortestSide(corners[id]);
    largest = std::max(largest, size);
    image.found[id] = (size - model.half_size) / model.spread + luck > 0.0;
    any = any || image.found[id];
  }
  if (!any) return image;
  // A sheet that is partly covered does not look like the print: PadAlignment turns it down.
  image.aligned = config_.occlusion == 0.0 && SheetIsAligned(placement, intrinsics_);
  const double sigma = config_.noise_scale *
                       At(model, image.aligned ? model.sheet_sigma : model.corner_sigma, largest);
  std::array<estimation::TagDetection, estimation::kPadTagCount> tags;
  std::size_t count = 0;
  for (std::size_t id = 0; id < tags.size(); ++id) {
    if (!(image.aligned ? in_sheet[id] : image.found[id])) continue;
    tags[count].id = static_cast<int>(id);
    tags[count].corners = corners[id];
    for (double& coordinate : tags[count].corners.reshaped()) coordinate += noise_.Normal(sigma);
    ++count;
  }
  estimation::PadPoseOptions options;
  options.corner_sigma = std::max(sigma, kMinSigma);
  options.corner_sigma_floor = options.corner_sigma;
  image.pose = estimation::SolvePadPose(
      std::span(tags.data(), count), intrinsics_, options,
      estimation::LevelPadNormal(believed.toRotationMatrix(), DownwardCameraAxes(),
                                 estimation::Radians(config_.attitude_sigma_deg)));
  return image;
}

std::optional<estimation::PadSighting> TagSensor::Poll(double t,
                                                       const estimation::VehicleState& vehicle,
                                                       const estimation::PadState& pad) {
  return clock_.Due(t) ? Sight(t, vehicle, pad, vehicle.q_WB) : std::nullopt;
}

std::optional<estimation::PadSighting> TagSensor::Sight(double t,
                                                        const estimation::VehicleState& vehicle,
                                                        const estimation::PadState& pad,
                                                        const Eigen::Quaterniond& believed) {
  const Image image = Look(vehicle, pad, believed);
  if (image.pose.status != estimation::PadPoseStatus::kSolved) return std::nullopt;
  estimation::PadSighting sighting =
      estimation::ToSighting(image.pose, t, DownwardCameraAxes(), config_.p_BC);
  sighting.tags_seen = static_cast<int>(std::count(image.found.begin(), image.found.end(), true));
  return sighting;
}

}  // namespace touchdown::sim
