// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"
#include "sim/pad/pad_geometry.h"

namespace touchdown::sim {

/// What is visible besides the vehicle, which its own cameras do not see.
struct VisualScene {
  ObstacleField obstacles;
  PadGeometry pad;
  double deck_height = 0.3;  ///< upper face of the deck above the ground [m]
  double occlusion = 0.0;    ///< share of the printed sheet under an opaque plate, in [0, 1)
};

/// The camera model: a pinhole camera with square pixels and its axis through the image's middle.
struct ViewConfig {
  int width = 320;          ///< [pixel], in [1, 4096]
  int height = 240;         ///< [pixel], in [1, 4096]
  double fov_y_deg = 90.0;  ///< vertical field of view [deg], in (0, 170]
  double near = 0.02;       ///< nothing nearer along the optical axis is drawn [m], in [0.005, 1]
  double far = 60.0;        ///< nor farther [m], in (near, 1000]
};

/// Where a camera is. C: x right, y down, z along the optical axis.
struct CameraPose {
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Matrix3d R_WC = Eigen::Matrix3d::Identity();  ///< C to W
};

/// Parts of the MJCF text of a scene. SceneAssets gives textures, materials and meshes, as in <asset>. SceneBodies
/// gives ground, obstacles and the mocap bodies "pad" and "camera", as in <worldbody>. See SceneMjcf, which throws
/// likewise.
std::string SceneAssets(const VisualScene& scene);
/// @param sheet how deep the printed sheet reaches into the deck [m].
std::string SceneBodies(const VisualScene& scene, const ViewConfig& view, double sheet);

/// MJCF text of the scene for rendering. The mocap bodies "pad" and "camera" are moved by hand. The
/// pad's origin is at the centre of the deck's upper face; the camera has x right, y up and looks
/// along -z. Nothing collides or moves by itself. Textures "ground" and "pad" are to be filled.
/// Throws std::invalid_argument for an obstacle that CheckGeom refuses (voxel columns, rings).
std::string SceneMjcf(const VisualScene& scene, const ViewConfig& view);

/// Edge of the square texture "ground" [texel].
inline constexpr int kGroundTexels = 512;

}  // namespace touchdown::sim
