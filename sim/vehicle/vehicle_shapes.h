// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::sim {

/// A geom of a vehicle, for pictures. G: the geom's own axes.
struct VehicleShape {
  enum class Kind { kSphere, kCapsule, kEllipsoid, kCylinder, kBox, kMesh };
  Kind kind = Kind::kBox;
  /// Half extents along G's axes (box, ellipsoid); radius (sphere); radius and half height without caps (others) [m].
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_BG = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond q_BG = Eigen::Quaterniond::Identity();
  Eigen::Vector4d rgba = Eigen::Vector4d::Ones();
  std::vector<Eigen::Vector3d> corners;    ///< of a mesh, in G [m]
  std::vector<Eigen::Vector3i> triangles;  ///< of a mesh, by their corners
};
const char* ToString(VehicleShape::Kind kind);

/// The visible shapes of the vehicle whose MJCF text is `mjcf` (vehicle_file.h). `hull`, wholly transparent geoms and
/// those in a group from 3 on are left out. If only feet remain, arms to the feet and rotors are added.
/// Throws std::invalid_argument as LoadVehicleModel.
std::vector<VehicleShape> VehicleShapes(const std::string& mjcf);

/// Radius of the rotors' discs as drawn: the model's, or 0.1 m where its file does not give it [m].
double DrawnRotorRadius(const estimation::VehicleModel& model);

}  // namespace touchdown::sim
