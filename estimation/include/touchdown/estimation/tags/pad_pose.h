// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/tag_detection.h"

namespace touchdown::estimation {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

enum class PadPoseStatus {
  kSolved,
  kNoTag,         ///< there is no corner to work on
  kDegenerate,    ///< the corners do not determine a pose
  kNotConverged,  ///< the iterations ended before the pose came to rest
  kInconsistent,  ///< no pose explains the corners
};

/// One sentence for people.
const char* Sentence(PadPoseStatus status);

/// The errors of an image's corners, and when corners are rejected. The pose's covariance follows
/// from the corners' noise. The noise is estimated from the residuals and from prior knowledge:
/// corner_sigma counts as much as corner_sigma_weight residuals do.
struct PadPoseOptions {
  double corner_sigma = 0.1;          ///< each axis [pixel], > 0
  double corner_sigma_weight = 20.0;  ///< in residuals, > 0
  double corner_sigma_floor = 0.02;   ///< the estimate is never below [pixel], > 0
  double outlier_rms = 5.0;           ///< of a tag's corners, in corner_sigma: dropped beyond, > 0
};

/// What is known of the deck's normal: the pad is level and the vehicle knows its attitude.
struct PadNormal {
  Eigen::Vector3d z_P_C = -Eigen::Vector3d::UnitZ();  ///< unit vector
  double sigma = 0.02;                                ///< about each axis across it [rad], > 0
};

/// The pad as seen from the camera.
struct PadPose {
  PadPoseStatus status = PadPoseStatus::kNoTag;
  Eigen::Vector3d p_CP = Eigen::Vector3d::Zero();      ///< pad centre in C [m]
  Eigen::Matrix3d R_CP = Eigen::Matrix3d::Identity();  ///< P to C
  /// Of (p_CP [m], rotation vector about C's axes [rad]): R_true = exp(rotation) R_CP.
  Matrix6d cov = Matrix6d::Zero();
  double corner_sigma = 0.0;  ///< estimated [pixel]
  int tags_used = 0;
  int dropped_id = -1;  ///< id of the tag whose corners did not fit; -1: none
  /// Two poses of a plane may look alike. Probability of the one not chosen, in [0, 0.5]; `cov`
  /// includes it.
  double other_probability = 0.0;
};

/// The pose that fits all corners of all tags best, by least squares of their distances in the
/// image. Does not allocate. Never throws because of an image's content.
/// @param tags with ids of PadTags(), each once.
/// @param normal decides between the two poses, and makes that of a single tag sharper.
/// Throws std::invalid_argument for options or a normal out of range, or for an id that the pad
/// lacks.
PadPose SolvePadPose(std::span<const TagDetection> tags, const CameraIntrinsics& camera,
                     const PadPoseOptions& options = {},
                     const std::optional<PadNormal>& normal = std::nullopt);

/// The pose as a measurement for the pad filter. The pose must be kSolved.
/// @param t time stamp of the image [s]. @param R_BC C to B. @param p_BC camera in B [m].
PadSighting ToSighting(const PadPose& pose, double t, const Eigen::Matrix3d& R_BC,
                       const Eigen::Vector3d& p_BC);

/// The deck's normal as a camera on a vehicle at attitude R_WB sees it.
/// @param sigma of the attitude, and of the deck's [rad].
PadNormal LevelPadNormal(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& R_BC, double sigma);

}  // namespace touchdown::estimation
