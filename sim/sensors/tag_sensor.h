// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "estimation/base/sample_clock.h"
#include "estimation/tags/pad_tags.h"
#include "sim/base/random_stream.h"
#include "sim/obstacles/obstacle_field.h"
#include "sim/pad/tag_model.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/estimation/tags/pad_pose.h"

namespace touchdown::sim {

/// Downward camera that sees the tags, and how it errs. C: x right (x_B), y down (-y_B), z down.
struct TagSensorConfig {
  int width = 320;          ///< [pixel]
  int height = 240;         ///< [pixel]
  double fov_y_deg = 90.0;  ///< vertical field of view, as MuJoCo's fovy [deg], in (0, 170]
  Eigen::Vector3d p_BC = {0.0, 0.0, -0.05};  ///< camera in B [m]
  double rate_hz = 20.0;                     ///< [Hz], in (0, 1000]
  double max_view_angle_deg = 75.0;  ///< between the line of sight and the deck's normal [deg]
  double attitude_sigma_deg = 1.0;   ///< claimed of the vehicle's attitude [deg], in [0.01, 45]
  double noise_scale = 1.0;          ///< factor on the corners' noise, in [0, 100]
  double occlusion = 0.0;  ///< share of the sheet under an opaque plate (PlateEdge), in [0, 0.95]
  TagModel model;
};

/// Measurement model of the pad camera: which tags are wholly in view and found, and where their
/// corners appear in the image. The pose is solved from the corners as from a rendered image. The
/// model stands in for rendering images and detecting tags in them.
class TagSensor {
 public:
  /// `seed` feeds the stream "tag camera". Throws std::invalid_argument naming key, value, range.
  TagSensor(const TagSensorConfig& config, const ObstacleField& obstacles, std::uint64_t seed);

  /// A sighting if an image is due at time t [s] and a tag is found in it, else nothing. Call once
  /// per simulation step. Does not allocate.
  std::optional<estimation::PadSighting> Poll(double t, const estimation::VehicleState& vehicle,
                                              const estimation::PadState& pad);

  /// The same without asking whether an image is due. @param believed the vehicle's estimate of its attitude, B to W:
  /// the deck's normal follows from it.
  std::optional<estimation::PadSighting> Sight(double t, const estimation::VehicleState& vehicle,
                                               const estimation::PadState& pad,
                                               const Eigen::Quaterniond& believed);

  /// Takes an image at once: the tags that are found, and the pad's pose in it. `believed` as above.
  struct Image {
    std::array<bool, estimation::kPadTagCount> found{};
    bool aligned = false;  ///< the pose is that of the whole sheet
    estimation::PadPose pose;
  };
  Image Look(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
             const Eigen::Quaterniond& believed);

  /// Which of estimation::PadTags() a camera at this pose has in view. All four corners of such a
  /// tag are in the image, at an admissible angle, with nothing in between or on them.
  std::array<bool, estimation::kPadTagCount> Visible(const estimation::VehicleState& vehicle,
                                                     const estimation::PadState& pad) const;

  const TagSensorConfig& config() const { return config_; }
  const estimation::CameraIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  TagSensorConfig config_;
  estimation::CameraIntrinsics intrinsics_;
  ObstacleField obstacles_;
  estimation::SampleClock clock_;
  RandomStream noise_;
};

}  // namespace touchdown::sim
