// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/solid.h"

#include <cmath>
#include <numbers>

namespace touchdown::evaluation {
namespace {

constexpr int kRound = 16;  // sides of the polygon that a circle is

TriangleSurface BoxSurface(const Eigen::Vector3d& size) {
  TriangleSurface surface;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5);
    surface.corners.emplace_back(corner.cwiseProduct(size));
  }
  surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return surface;
}

TriangleSurface CylinderSurface(const Eigen::Vector3d& size) {
  TriangleSurface surface;
  surface.corners = {-0.5 * size.z() * Eigen::Vector3d::UnitZ(),
                     0.5 * size.z() * Eigen::Vector3d::UnitZ()};
  for (int i = 0; i < kRound; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kRound;
    for (const double z : {-0.5, 0.5}) {
      surface.corners.emplace_back(0.5 * size.x() * std::cos(turn), 0.5 * size.y() * std::sin(turn),
                                   z * size.z());
    }
    const int low = 2 + 2 * i, next = 2 + 2 * ((i + 1) % kRound);
    surface.triangles.insert(
        surface.triangles.end(),
        {{0, next, low}, {1, low + 1, next + 1}, {low, next, next + 1}, {low, next + 1, low + 1}});
  }
  return surface;
}

TriangleSurface EllipsoidSurface(const Eigen::Vector3d& size) {
  TriangleSurface surface;
  const int rings = kRound / 2;
  for (int ring = 0; ring <= rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int i = 0; i < kRound; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / kRound;
      const Eigen::Vector3d corner(std::sin(polar) * std::cos(turn),
                                   std::sin(polar) * std::sin(turn), std::cos(polar));
      surface.corners.emplace_back(0.5 * corner.cwiseProduct(size));
      if (ring == rings) continue;
      const int here = ring * kRound + i, side = ring * kRound + (i + 1) % kRound;
      // At the poles one of the two has no area.
      if (ring > 0) surface.triangles.emplace_back(here, here + kRound, side);
      if (ring + 1 < rings) surface.triangles.emplace_back(side, here + kRound, side + kRound);
    }
  }
  return surface;
}

}  // namespace

TriangleSurface SurfaceOf(const Solid& solid) {
  switch (solid.kind) {
    case Solid::Kind::kBox:
      return BoxSurface(solid.size);
    case Solid::Kind::kEllipsoid:
      return EllipsoidSurface(solid.size);
    case Solid::Kind::kCylinder:
      return CylinderSurface(solid.size);
    case Solid::Kind::kSurface:
      break;
  }
  return solid.surface;
}

double AreaOf(const TriangleSurface& surface) {
  double area = 0.0;
  for (const Eigen::Vector3i& triangle : surface.triangles) {
    const auto corner = [&](int i) -> const Eigen::Vector3d& {
      return surface.corners[static_cast<std::size_t>(triangle[i])];
    };
    area += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return area;
}

}  // namespace touchdown::evaluation
