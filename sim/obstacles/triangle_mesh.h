// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/bounds_tree.h"
#include "sim/obstacles/ray_intersection.h"

namespace touchdown::sim {

/// What triangles enclose [m^3]; negative where they are seen with the clock from outside.
double SignedVolume(const std::vector<Eigen::Vector3d>& corners,
                    const std::vector<Eigen::Vector3i>& triangles);

/// "(x, y, z)" for sentences.
std::string PlaceText(const Eigen::Vector3d& p);

/// A solid by its surface: triangles that close it, each seen from outside against the clock. Its surface is one piece
/// and does not cut itself; that alone is not checked. Distances and rays are exact, by a tree of bounds.
class TriangleMesh {
 public:
  /// Corners in W [m], and per triangle the indices of its three. If all triangles face inwards, all are turned.
  /// @throws std::invalid_argument naming the triangle or the edge. Faults: no triangle; a corner that is not finite;
  /// an index of no corner; a triangle without an area; an edge without exactly two triangles, or that both traverse in
  /// the same direction.
  TriangleMesh(std::vector<Eigen::Vector3d> corners, std::vector<Eigen::Vector3i> triangles);

  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }
  const std::vector<Eigen::Vector3i>& triangles() const { return triangles_; }
  const Bounds& bounds() const { return bounds_; }
  double Volume() const { return SignedVolume(corners_, triangles_); }  ///< [m^3], > 0

  /// To the surface [m], negative inside. Does not allocate.
  double SignedDistance(const Eigen::Vector3d& p_W) const;
  /// Smallest s >= 0 at which origin + s * direction crosses the surface, +infinity if it never does. Does not allocate.
  double RayDistance(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W) const;
  /// Visits each Triangle whose bounds overlap the place, and a few that are near to such. Does not allocate.
  template <class Visit>
  void Within(const Bounds& place, Visit&& visit) const {
    tree_.PlacesWithin(place, [&](int at) { visit(sides_[static_cast<std::size_t>(at)]); });
  }
  /// Whether the solid reaches into the place. Does not allocate.
  bool Meets(const Bounds& place) const;

 private:
  const Eigen::Vector3d& Corner(int triangle, int i) const {
    return corners_[static_cast<std::size_t>(triangles_[static_cast<std::size_t>(triangle)][i])];
  }
  void Check() const;
  std::vector<Bounds> EachBounds();
  void PairEdges();
  void SetNormals();

  std::vector<Eigen::Vector3d> corners_;
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<std::array<int, 3>> across_;  ///< the triangle beyond side i, from corner i to i + 1
  std::vector<Eigen::Vector3d> normals_;    ///< of the triangles, outward, of length 1
  std::vector<Eigen::Vector3d> corner_normals_;  ///< sums of those about it, by their angles there
  Bounds bounds_;
  BoundsTree tree_;
  std::vector<Triangle> sides_;  ///< in the tree's order: rays are many
};

}  // namespace touchdown::sim
