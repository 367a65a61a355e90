// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "evaluation/mcap/message_parts.h"

namespace touchdown::evaluation {

/// Triangles, by their corners.
struct TriangleSurface {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3i> triangles;
};

/// A shape that is drawn.
struct Solid {
  enum class Kind { kBox, kEllipsoid, kCylinder, kSurface };
  Kind kind = Kind::kBox;
  Eigen::Isometry3d pose =
      Eigen::Isometry3d::Identity();               ///< of its middle; a cylinder's axis is z
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< whole extents along the pose's axes [m]
  Color color;
  TriangleSurface surface;  ///< of kSurface, in the pose's axes
};

/// Its surface in its pose's axes, round ones as polygons.
TriangleSurface SurfaceOf(const Solid& solid);

/// Of all its triangles [m^2].
double AreaOf(const TriangleSurface& surface);

}  // namespace touchdown::evaluation
