// SPDX-License-Identifier: BSD-3-Clause
// The nearest point of the surface lies in a triangle, on an edge or at a corner. The sign is that of the offset along
// the normal there. This is the triangle's normal, the sum of an edge's two, or the sum at a corner weighted by the
// angles. It is right for every closed surface (Baerentzen and Aanaes, Signed distance computation using the angle
// weighted pseudonormal, IEEE TVCG 11(3), 2005).
#include "sim/obstacles/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"
#include "sim/obstacles/ray_intersection.h"

namespace touchdown::sim {
namespace {

constexpr double kFlat = 1e-9;  // height of a triangle over its longest side: it has no area

// A place of the surface: in the triangle (kInside), on its side i from corner i, or at its corner i.
struct Nearest {
  enum class Kind { kInside, kSide, kCorner };
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Kind kind = Kind::kInside;
  int i = 0;
};

// By the regions of the plane about the triangle: C. Ericson, Real-Time Collision Detection, 5.1.5.
Nearest NearestOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  const Eigen::Vector3d& p) {
  using Kind = Nearest::Kind;
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, Kind::kCorner, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {b, Kind::kCorner, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {a + d1 / (d1 - d3) * ab, Kind::kSide, 0};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {c, Kind::kCorner, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {a + d2 / (d2 - d6) * ac, Kind::kSide, 2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), Kind::kSide, 1};
  }
  const double scale = 1.0 / (va + vb + vc);
  return {a + vb * scale * ab + vc * scale * ac, Kind::kInside, 0};
}

// Whether a triangle reaches into a box about the origin, by separating axes. The axes are the box's three, the
// triangle's normal, and the products of the edges of both (T. Akenine-Moeller, Fast 3D triangle-box overlap testing,
// 2001).
bool ReachesIn(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Array3d& half) {
  const auto apart = [&](const Eigen::Vector3d& axis) {
    const double reach = (half * axis.array().abs()).sum();
    const auto [low, high] =
        std::minmax({corners[0].dot(axis), corners[1].dot(axis), corners[2].dot(axis)});
    return low > reach || high < -reach;
  };
  const std::array<Eigen::Vector3d, 3> edges = {corners[1] - corners[0], corners[2] - corners[1],
                                                corners[0] - corners[2]};
  if (apart(edges[0].cross(edges[1]))) return false;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    if (apart(axis)) return false;
    for (const Eigen::Vector3d& edge : edges) {
      if (apart(axis.cross(edge))) return false;
    }
  }
  return true;
}

std::uint64_t EdgeKey(int from, int to) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 |
         static_cast<std::uint32_t>(to);
}

}  // namespace

double SignedVolume(const std::vector<Eigen::Vector3d>& corners,
                    const std::vector<Eigen::Vector3i>& triangles) {
  double six = 0.0;
  const auto at = [&](int i) -> Eigen::Vector3d {
    return corners[static_cast<std::size_t>(i)] - corners.front();
  };
  for (const Eigen::Vector3i& of : triangles) six += at(of[0]).dot(at(of[1]).cross(at(of[2])));
  return six / 6.0;
}

std::string PlaceText(const Eigen::Vector3d& p) {
  return "(" + estimation::NumberText(p.x()) + ", " + estimation::NumberText(p.y()) + ", " +
         estimation::NumberText(p.z()) + ")";
}

TriangleMesh::TriangleMesh(std::vector<Eigen::Vector3d> corners,
                           std::vector<Eigen::Vector3i> triangles)
    : corners_(std::move(corners)), triangles_(std::move(triangles)) {
  Check();
  if (Volume() < 0.0) {
    for (Eigen::Vector3i& triangle : triangles_) std::swap(triangle[1], triangle[2]);
  }
  PairEdges();
  SetNormals();
  tree_ = BoundsTree(EachBounds());
  for (const int t : tree_.order()) {
    const Eigen::Vector3d& a = Corner(t, 0);
    sides_.push_back({a, Corner(t, 1) - a, Corner(t, 2) - a});
  }
}

std::vector<Bounds> TriangleMesh::EachBounds() {
  std::vector<Bounds> each;
  each.reserve(triangles_.size());
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const Eigen::Vector3d &a = Corner(t, 0), &b = Corner(t, 1), &c = Corner(t, 2);
    each.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
    if (t == 0) bounds_ = each.front();
    bounds_.min = bounds_.min.cwiseMin(each.back().min);
    bounds_.max = bounds_.max.cwiseMax(each.back().max);
  }
  return each;
}

void TriangleMesh::Check() const {
  if (triangles_.empty()) throw std::invalid_argument("there is no triangle");
  const int count = static_cast<int>(corners_.size());
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const std::string name = "triangle " + std::to_string(t);
    const Eigen::Vector3i& of = triangles_[static_cast<std::size_t>(t)];
    for (const int i : of) {
      if (i < 0 || i >= count) {
        throw std::invalid_argument(name + " has corner " + std::to_string(i) + " of " +
                                    std::to_string(count));
      }
      if (!corners_[static_cast<std::size_t>(i)].allFinite()) {
        throw std::invalid_argument(name + " has a corner that is not finite");
      }
    }
    const Eigen::Vector3d ab = Corner(t, 1) - Corner(t, 0), ac = Corner(t, 2) - Corner(t, 0);
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (!(ab.cross(ac).norm() > kFlat * longest)) {
      throw std::invalid_argument(name + " at " + PlaceText(Corner(t, 0)) + " has no area");
    }
  }
}

void TriangleMesh::PairEdges() {
  std::unordered_map<std::uint64_t, int> along;
  along.reserve(3 * triangles_.size());
  const auto edge = [&](int t, int i) {
    const Eigen::Vector3i& of = triangles_[static_cast<std::size_t>(t)];
    return std::pair(of[i], of[(i + 1) % 3]);
  };
  const auto refuse = [&](int t, int i, const char* why) {
    throw std::invalid_argument("the edge of triangle " + std::to_string(t) + " from " +
                                PlaceText(Corner(t, i)) + " to " +
                                PlaceText(Corner(t, (i + 1) % 3)) + " " + why);
  };
  const int count = static_cast<int>(triangles_.size());
  for (int t = 0; t < count; ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [from, to] = edge(t, i);
      if (!along.emplace(EdgeKey(from, to), t).second) {
        refuse(t, i, "belongs to another triangle in the same sense");
      }
    }
  }
  across_.resize(triangles_.size());
  for (int t = 0; t < count; ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [from, to] = edge(t, i);
      const auto found = along.find(EdgeKey(to, from));
      if (found == along.end()) refuse(t, i, "belongs to no other triangle: the surface is open");
      across_[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)] = found->second;
    }
  }
}

void TriangleMesh::SetNormals() {
  corner_normals_.assign(corners_.size(), Eigen::Vector3d::Zero());
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const Eigen::Vector3d n =
        (Corner(t, 1) - Corner(t, 0)).cross(Corner(t, 2) - Corner(t, 0)).normalized();
    normals_.push_back(n);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d one = Corner(t, (i + 1) % 3) - Corner(t, i);
      const Eigen::Vector3d other = Corner(t, (i + 2) % 3) - Corner(t, i);
      const double angle = std::atan2(one.cross(other).norm(), one.dot(other));
      corner_normals_[static_cast<std::size_t>(triangles_[static_cast<std::size_t>(t)][i])] +=
          angle * n;
    }
  }
}

double TriangleMesh::SignedDistance(const Eigen::Vector3d& p_W) const {
  double nearest = kInfinity;
  int triangle = 0;
  Nearest place;
  tree_.Near(p_W, &nearest, [&](int t) {
    const Nearest found = NearestOf(Corner(t, 0), Corner(t, 1), Corner(t, 2), p_W);
    const double distance = (p_W - found.p).norm();
    if (!(distance < nearest)) return;
    nearest = distance;
    triangle = t;
    place = found;
  });
  const auto t = static_cast<std::size_t>(triangle);
  Eigen::Vector3d normal = normals_[t];
  if (place.kind == Nearest::Kind::kSide) {
    normal += normals_[static_cast<std::size_t>(across_[t][static_cast<std::size_t>(place.i)])];
  } else if (place.kind == Nearest::Kind::kCorner) {
    normal = corner_normals_[static_cast<std::size_t>(triangles_[t][place.i])];
  }
  return normal.dot(p_W - place.p) < 0.0 ? -nearest : nearest;
}

double TriangleMesh::RayDistance(const Eigen::Vector3d& origin_W,
                                 const Eigen::Vector3d& direction_W) const {
  double first = kInfinity;
  tree_.AlongPlaces(origin_W, direction_W, &first, [&](int place) {
    first = std::min(first,
                     RayTriangle(sides_[static_cast<std::size_t>(place)], origin_W, direction_W));
  });
  return first;
}

bool TriangleMesh::Meets(const Bounds& place) const {
  const Eigen::Vector3d middle = 0.5 * (place.min + place.max);
  const Eigen::Array3d half = 0.5 * (place.max - place.min).array();
  bool reaches_in = false;
  tree_.Within(place, [&](int t) {
    reaches_in =
        reaches_in ||
        ReachesIn({Corner(t, 0) - middle, Corner(t, 1) - middle, Corner(t, 2) - middle}, half);
  });
  return reaches_in || SignedDistance(middle) < 0.0;
}

}  // namespace touchdown::sim
