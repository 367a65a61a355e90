// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "evaluation/mcap/message_parts.h"
#include "evaluation/mcap/solid.h"

namespace touchdown::evaluation {

struct CloudPoint {
  Eigen::Vector3d p;  ///< in the cloud's frame [m]
  Color color;
};
using CloudPoints = std::vector<CloudPoint>;

/// Of a point in a message.
inline constexpr std::size_t kPointBytes = 16;

/// foxglove.PointCloud, with x, y, z as 32-bit floats and red, green, blue, alpha as bytes.
std::string PointCloud(double t, const std::string& frame, const CloudPoints& points);

/// Adds points all over the surface of a solid: neighbours along a side are `spacing` apart at most [m].
void AddSurface(const Solid& solid, double spacing, CloudPoints* points);

}  // namespace touchdown::evaluation
