// SPDX-License-Identifier: BSD-3-Clause
// Measurement model of five TAG36H11 markers seen by a downward camera. It is a model: constants
// are read off a table of libapriltag 3.3 detections on noise-free rendered images (320x240, fovy
// 60 deg, focal length 207.8 pixel, tilt to 9 deg, 8 poses per height), not a derivation. z: camera
// to pad.
//
//  what                                       table                           model
//  central tag (0.15 m) found                 to 3 m, not at 4 m              to 3 m
//  outer tags (0.4 m) found                   to 6 m, the table's end         to 6 m
//  position, several tags, mean |error|       0.5-1.5 mm to 3 m; 2.9 at 4;    0.5 mm + 0.2 mm/m^2
//  z^2
//                                             5.2 at 5; 4.9 at 6 m
//  position, one tag of side s, mean |error|  outer 2 / 9 / 30 / 68 / 128 mm  0.5 mm + 2 mm
//  (x/2)^3.8,
//                                             at 2 / 3 / 4 / 5 / 6 m;         x = z 0.4 / s
//                                             central 0.3 / 0.7 / 38 mm
//                                             at 0.3 / 0.6 / 2 m
//  rotation, several tags                     0.03-0.8 deg                    0.1 deg + 0.1 deg/m z
//  rotation, one tag                          central 0.1-1.1 deg at 0.3 to   0.5 deg + 0.33 deg
//  x^2
//                                             0.6 m, 9.5 at 2 m; outer 4-10
//
// Ranges and errors are carried over to another camera by its focal length: a tag then has the same
// size in pixels at focal / 207.8 times the distance. A mean |error| in space is 1.6 standard
// deviations of one axis. Images with noise and motion blur are worse than the table's: factor 2.

#include "touchdown/sim/tag_sensor.h"

#include <cmath>
#include <numbers>

#include "touchdown/sim/argument_check.h"

namespace touchdown::sim {
namespace {

constexpr double kTableFocal = 207.8;       // [pixel]
constexpr double kCentralRange = 3.0;       // at the table's focal length [m]
constexpr double kOuterRange = 6.0;         // [m]
constexpr double kOuterSide = 0.4;          // [m]
constexpr double kImageNoiseFactor = 2.0;   // images that are not noise-free
constexpr double kMeanNormOverSigma = 1.6;  // of a three-dimensional normal: 2 sqrt(2 / pi)

double Radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

struct PoseSigma {
  double position = 0.0;  // each axis [m]
  double yaw = 0.0;       // [rad]
};

// @param z distance from camera to pad, scaled to the table's focal length [m].
// @param side of the tag, read if only one is seen [m].
PoseSigma SigmaOf(double z, int tags_seen, double side) {
  double error_m = 0.0;
  double error_deg = 0.0;
  if (tags_seen > 1) {
    error_m = 0.5e-3 + 0.2e-3 * z * z;
    error_deg = 0.1 + 0.1 * z;
  } else {
    const double x = z * kOuterSide / side;
    error_m = 0.5e-3 + 2.0e-3 * std::pow(0.5 * x, 3.8);
    error_deg = 0.5 + 0.33 * x * x;
  }
  const double factor = kImageNoiseFactor / kMeanNormOverSigma;
  return {factor * error_m, factor * Radians(error_deg)};
}

bool InImage(const estimation::CameraIntrinsics& camera, const Eigen::Vector3d& p_C) {
  if (p_C.z() <= 0.0) return false;
  const double u = camera.cx + camera.focal * p_C.x() / p_C.z();
  const double v = camera.cy + camera.focal * p_C.y() / p_C.z();
  return u >= 0.0 && u <= camera.width && v >= 0.0 && v <= camera.height;
}

// The camera's axes in B: the image's right is x_B, its up is y_B.
Eigen::Matrix3d DownwardCamera() { return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal(); }

}  // namespace

TagSensor::TagSensor(const TagSensorConfig& config, const ObstacleField& obstacles,
                     std::uint64_t seed)
    : config_(config), obstacles_(obstacles), clock_(config.rate_hz), noise_(seed, "tag camera") {
  CheckWithin("tag_camera.width", config.width, 1, 4096);
  CheckWithin("tag_camera.height", config.height, 1, 4096);
  CheckAbove("tag_camera.fov_y_deg", config.fov_y_deg, 0.0, 170.0);
  CheckWithin("tag_camera.max_view_angle_deg", config.max_view_angle_deg, 0.0, 89.0);
  CheckWithin("tag_camera.noise_scale", config.noise_scale, 0.0, 100.0);
  CheckWithin("length of tag_camera.p_BC", config.p_BC.norm(), 0.0, 10.0);
  intrinsics_.width = config.width;
  intrinsics_.height = config.height;
  intrinsics_.focal = 0.5 * config.height / std::tan(0.5 * Radians(config.fov_y_deg));
  intrinsics_.cx = 0.5 * config.width;
  intrinsics_.cy = 0.5 * config.height;
}

std::array<bool, estimation::kPadTagCount> TagSensor::Visible(
    const estimation::VehicleState& vehicle, const estimation::PadState& pad) const {
  const Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
  const Eigen::Matrix3d R_WC = R_WB * DownwardCamera();
  const Eigen::Vector3d p_WC = vehicle.p_WB + R_WB * config_.p_BC;
  const double cos_limit = std::cos(Radians(config_.max_view_angle_deg));
  const double range_scale = intrinsics_.focal / kTableFocal;
  const Eigen::Vector3d x_P(std::cos(pad.yaw), std::sin(pad.yaw), 0.0);
  const Eigen::Vector3d y_P(-x_P.y(), x_P.x(), 0.0);

  const auto corner_seen = [&](const Eigen::Vector3d& corner_W) {
    return InImage(intrinsics_, R_WC.transpose() * (corner_W - p_WC)) &&
           // Of the ray from camera (0) to corner (1), nothing may cross before 1.
           obstacles_.RayDistance(p_WC, corner_W - p_WC) >= 1.0;
  };
  std::array<bool, estimation::kPadTagCount> visible{};
  const auto& tags = estimation::PadTags();
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const estimation::PadTag& tag = tags[i];
    const Eigen::Vector3d center_W = pad.p_WP + tag.center_P.x() * x_P + tag.center_P.y() * y_P;
    const Eigen::Vector3d to_camera = p_WC - center_W;
    const double distance = to_camera.norm();
    const double range = range_scale * (i == 0 ? kCentralRange : kOuterRange);
    if (distance > range || to_camera.z() < cos_limit * distance) continue;
    const Eigen::Vector3d dx = 0.5 * tag.side * x_P;
    const Eigen::Vector3d dy = 0.5 * tag.side * y_P;
    visible[i] = corner_seen(center_W + dx + dy) && corner_seen(center_W - dx + dy) &&
                 corner_seen(center_W - dx - dy) && corner_seen(center_W + dx - dy);
  }
  return visible;
}

std::optional<estimation::PadSighting> TagSensor::Poll(double t,
                                                       const estimation::VehicleState& vehicle,
                                                       const estimation::PadState& pad) {
  if (!clock_.Due(t)) return std::nullopt;
  const std::array<bool, estimation::kPadTagCount> visible = Visible(vehicle, pad);
  const auto& tags = estimation::PadTags();
  estimation::PadSighting sighting;
  double side = 0.0;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    if (!visible[i]) continue;
    ++sighting.tags_seen;
    side = tags[i].side;
  }
  if (sighting.tags_seen == 0) return std::nullopt;

  const Eigen::Matrix3d R_BW = vehicle.q_WB.toRotationMatrix().transpose();
  const Eigen::Vector3d p_BP_B = R_BW * (pad.p_WP - vehicle.p_WB);
  const Eigen::Vector3d x_P_B = R_BW * Eigen::Vector3d(std::cos(pad.yaw), std::sin(pad.yaw), 0.0);
  const double z = (p_BP_B - config_.p_BC).norm() * kTableFocal / intrinsics_.focal;
  const PoseSigma sigma = SigmaOf(z, sighting.tags_seen, side);
  sighting.t = t;
  sighting.sigma_p.setConstant(config_.noise_scale * sigma.position);
  sighting.sigma_yaw = config_.noise_scale * sigma.yaw;
  for (int axis = 0; axis < 3; ++axis) {
    sighting.p_BP_B[axis] = p_BP_B[axis] + noise_.Normal(sighting.sigma_p[axis]);
  }
  const double yaw = std::atan2(x_P_B.y(), x_P_B.x()) + noise_.Normal(sighting.sigma_yaw);
  sighting.yaw_BP = estimation::WrapAngle(yaw);
  return sighting;
}

}  // namespace touchdown::sim
