// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/point_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace touchdown::evaluation {
namespace {

void AddField(protozero::pbf_writer* cloud, const char* name, std::uint32_t offset, int type) {
  protozero::pbf_writer field(*cloud, 5);
  field.add_string(1, name);
  field.add_fixed32(2, offset);
  field.add_enum(3, type);
}

}  // namespace

std::string PointCloud(double t, const std::string& frame, const CloudPoints& points) {
  constexpr int kByte = 1, kFloat = 7;
  std::string bytes;
  protozero::pbf_writer cloud(bytes);
  AddTime(&cloud, 1, t);
  cloud.add_string(2, frame);
  AddPose(&cloud, 3, Eigen::Isometry3d::Identity());
  cloud.add_fixed32(4, kPointBytes);
  std::uint32_t offset = 0;
  for (const char* axis : {"x", "y", "z"}) {
    AddField(&cloud, axis, offset, kFloat);
    offset += sizeof(float);
  }
  for (const char* share : {"red", "green", "blue", "alpha"}) {
    AddField(&cloud, share, offset++, kByte);
  }
  std::string data;
  data.reserve(kPointBytes * points.size());
  for (const CloudPoint& point : points) {
    std::array<char, kPointBytes> packed;
    const Eigen::Vector3f p = point.p.cast<float>();
    std::memcpy(packed.data(), p.data(), 3 * sizeof(float));
    const Color& color = point.color;
    std::size_t at = 3 * sizeof(float);
    for (const double share : {color.r, color.g, color.b, color.a}) {
      packed[at++] = static_cast<char>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
    }
    data.append(packed.data(), packed.size());
  }
  cloud.add_bytes(6, data);
  return bytes;
}

void AddSurface(const Solid& solid, double spacing, CloudPoints* points) {
  const TriangleSurface surface = SurfaceOf(solid);
  for (const Eigen::Vector3i& triangle : surface.triangles) {
    const auto corner = [&](int i) -> Eigen::Vector3d {
      return solid.pose * surface.corners[static_cast<std::size_t>(triangle[i])];
    };
    // Rows from the longest side to the corner across it, so that a long and thin triangle has one row of points.
    int apex = 0;
    double longest = -1.0;
    for (int i = 0; i < 3; ++i) {
      const double side = (corner((i + 1) % 3) - corner((i + 2) % 3)).norm();
      if (side > longest) {
        longest = side;
        apex = i;
      }
    }
    const Eigen::Vector3d c = corner(apex), a = corner((apex + 1) % 3), b = corner((apex + 2) % 3);
    const double height = (b - a).cross(c - a).norm() / std::max(longest, 1e-9);
    const int rows = std::max(1, static_cast<int>(std::ceil(height / spacing)));
    for (int row = 0; row < rows; ++row) {
      const double up = (row + 0.5) / rows;
      const int columns = std::max(1, static_cast<int>(std::ceil((1.0 - up) * longest / spacing)));
      for (int column = 0; column < columns; ++column) {
        const double along = (column + 0.5) / columns;
        points->push_back({up * c + (1.0 - up) * (a + along * (b - a)), solid.color});
      }
    }
  }
}

}  // namespace touchdown::evaluation
