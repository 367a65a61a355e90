// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "touchdown/estimation/tags/pad_pose.h"

namespace touchdown::estimation {

/// Most corners that an image can hold.
inline constexpr int kMaxCorners = 20;

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A pose under way: P to C. It moves by (translation, rotation vector about C's axes).
struct PoseCP {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();

  PoseCP Moved(const Vector6d& step) const;
};

/// Corners on the pad beside where they appear in the image.
struct PadCorners {
  int count = 0;
  std::array<Eigen::Vector2d, kMaxCorners> on_pad;    ///< in P [m]
  std::array<Eigen::Vector2d, kMaxCorners> in_image;  ///< [pixel]

  PadCorners() = default;
  /// All tags but the one with index `left_out`.
  explicit PadCorners(std::span<const TagDetection> tags, int left_out = -1);
};

/// Offset from a corner in the image to its projection by the pose [pixel], with its derivative by
/// a move of the pose. Nothing for a corner that is not in front of the camera.
struct CornerResidual {
  Eigen::Vector2d offset;
  Eigen::Matrix<double, 2, 6> jacobian;
};
std::optional<CornerResidual> ResidualOf(const PadCorners& corners, int i, const PoseCP& pose,
                                         const CameraIntrinsics& camera);

/// The two components of the pose's normal across the one that is known [rad], with derivatives.
struct NormalResidual {
  Eigen::Vector2d offset;
  Eigen::Matrix<double, 2, 6> jacobian;
};
NormalResidual ResidualOf(const PadNormal& normal, const PoseCP& pose);

/// Sums that least squares need: squares (half of them is the cost), J^T r and J^T J. Corners and
/// normal are kept apart, because the corners' weight is only known afterwards.
struct NormalEquations {
  bool in_front = false;  ///< all corners are; else the rest means nothing
  double squares = 0.0;
  Vector6d gradient = Vector6d::Zero();
  Matrix6d hessian = Matrix6d::Zero();
};
NormalEquations Assemble(const PadCorners& corners, const CameraIntrinsics& camera,
                         const PoseCP& pose);
NormalEquations Assemble(const PadNormal& normal, const PoseCP& pose);

/// A pose from the homography that maps pad to image best: a first guess for least squares. Nothing
/// if there is none.
std::optional<PoseCP> PoseFromHomography(const PadCorners& corners, const CameraIntrinsics& camera);

/// The other pose that a far plane may have for nearly the same image. It is mirrored at the plane
/// through the corners' centre across the line of sight.
PoseCP MirroredPose(const PadCorners& corners, const PoseCP& pose);

}  // namespace touchdown::estimation
