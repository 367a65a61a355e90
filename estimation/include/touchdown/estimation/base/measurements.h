// SPDX-License-Identifier: BSD-3-Clause
// What the sensors deliver, as plain data. Produced by sim/, consumed by estimation/ and planning/.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "touchdown/estimation/base/gray_image.h"

namespace touchdown::estimation {

/// Pinhole camera without distortion. C: camera frame, x right, y down, z along the optical axis.
struct CameraIntrinsics {
  int width = 80;       ///< [pixel]
  int height = 60;      ///< [pixel]
  double focal = 40.0;  ///< focal length, both axes [pixel]
  double cx = 40.0;     ///< principal point [pixel], pixel (u, v) has its centre at (u+0.5, v+0.5)
  double cy = 30.0;
};

/// One depth image with the pose it was taken from.
struct DepthFrame {
  double t = 0.0;  ///< time stamp [s]
  CameraIntrinsics intrinsics;
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();      ///< camera in W [m]
  Eigen::Matrix3d R_WC = Eigen::Matrix3d::Identity();  ///< C to W
  double max_range = 6.0;  ///< returns beyond this distance along the ray are not reported [m]
  std::vector<float>
      depth;  ///< height x width, row-major, along the optical axis [m]; inf: no return. A pixel that
              ///< is none of both, or beyond the range, says nothing
};

/// Whether a camera can have taken it: positive focal length, an image plane no wider than 1e4
/// focal lengths, a valid pose within 1e7 m, and a range. Does not check the depths.
bool IsPossible(const DepthFrame& frame);

/// One depth image from a camera that is fixed to the vehicle.
struct DepthImage {
  double t = 0.0;  ///< time stamp [s]
  CameraIntrinsics intrinsics;
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();      ///< camera in B [m]
  Eigen::Matrix3d R_BC = Eigen::Matrix3d::Identity();  ///< C to B
  double max_range = 6.0;                              ///< as in DepthFrame [m]
  std::vector<float> depth;                            ///< as in DepthFrame [m]
};

/// Whether such a camera can have taken it, as above, and its pixels are all there.
bool IsPossible(const DepthImage& image);
/// Whether its pixels carry information, and not fewer than are returns from beyond the range, as
/// in an image in millimetres.
bool SaysSomething(const DepthImage& image);

/// Position of the pad by GPS (horizontal, in W). The paper's eq. 11 without its heading.
struct PadGpsFix {
  double t = 0.0;                                  ///< time stamp [s]
  Eigen::Vector2d p_WP = Eigen::Vector2d::Zero();  ///< [m]
  double sigma = 0.01;                             ///< standard deviation, each axis [m], >= 0
};

/// One grey image from a camera that is fixed to the vehicle and looks for the pad's tags.
struct PadImage {
  double t = 0.0;                                      ///< middle of the exposure [s]
  CameraIntrinsics intrinsics;                         ///< of this size is `gray`
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();      ///< camera in B [m]
  Eigen::Matrix3d R_BC = Eigen::Matrix3d::Identity();  ///< C to B
  GrayImage gray;
};

/// Whether such a camera can have taken it, as above, and its pixels are all there.
bool IsPossible(const PadImage& image);

/// Pose of the pad seen by the downward camera through its tags, relative to the vehicle.
struct PadSighting {
  double t = 0.0;                                     ///< time stamp [s]
  Eigen::Vector3d p_BP_B = Eigen::Vector3d::Zero();   ///< pad centre from B's origin, in B [m]
  double yaw_BP = 0.0;                                ///< heading of the pad's x axis in B [rad]
  Eigen::Vector3d sigma_p = Eigen::Vector3d::Zero();  ///< standard deviation along B's axes [m]
  double sigma_yaw = 0.0;                             ///< [rad]
  int tags_seen = 0;                                  ///< tags wholly in view, 1 to 5
};

/// Sum of the forces on the landing feet, as foot switches with a load cell give it.
struct FootForce {
  double t = 0.0;      ///< time stamp [s]
  double force = 0.0;  ///< [N]
};

}  // namespace touchdown::estimation
