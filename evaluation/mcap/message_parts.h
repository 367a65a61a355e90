// SPDX-License-Identifier: BSD-3-Clause
// Parts that Foxglove's protobuf messages are made of. Numbers of fields are those of their definitions, whose descriptors
// are in evaluation/data/mcap.
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <protozero/pbf_writer.hpp>

namespace touchdown::evaluation {

/// From 0 to 1 each.
struct Color {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
};

/// Flight time in whole nanoseconds; none is before 0.
std::uint64_t Nanoseconds(double t);

/// google.protobuf.Timestamp.
void AddTime(protozero::pbf_writer* to, unsigned field, double t);
/// foxglove.Vector3 and foxglove.Point3.
void AddVector(protozero::pbf_writer* to, unsigned field, const Eigen::Vector3d& v);
/// foxglove.Quaternion.
void AddQuaternion(protozero::pbf_writer* to, unsigned field, const Eigen::Quaterniond& q);
/// foxglove.Pose.
void AddPose(protozero::pbf_writer* to, unsigned field, const Eigen::Isometry3d& pose);
/// foxglove.Color.
void AddColor(protozero::pbf_writer* to, unsigned field, const Color& color);

/// A pose from its parts.
Eigen::Isometry3d PoseOf(const Eigen::Vector3d& p, const Eigen::Quaterniond& q);

}  // namespace touchdown::evaluation
