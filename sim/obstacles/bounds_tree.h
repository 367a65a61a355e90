// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace touchdown::sim {

/// Axis-aligned bounds in W [m].
struct Bounds {
  Eigen::Vector3d min;
  Eigen::Vector3d max;

  bool Overlaps(const Bounds& other) const {
    return (min.array() <= other.max.array()).all() && (max.array() >= other.min.array()).all();
  }
  /// From the point to the surface [m], negative inside: of all that lies in it, no signed distance is less.
  double SignedDistance(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d beyond = (min - p_W).cwiseMax(p_W - max);
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
  }
};

/// Many things by their bounds, in a tree of bounds: what a point is near to, what a ray may meet, what lies in a
/// place, each in about the logarithm of their number. A visitor gets a thing's index; what it finds ends the search
/// the sooner. No search allocates.
class BoundsTree {
 public:
  BoundsTree() = default;
  explicit BoundsTree(const std::vector<Bounds>& things);

  /// Visits what may have a signed distance to the point below *nearest [m], which the visitor lowers.
  template <class Visit>
  void Near(const Eigen::Vector3d& p_W, double* nearest, Visit&& visit) const {
    Search([&](const Bounds& bounds) { return bounds.SignedDistance(p_W); }, nearest, visit);
  }

  /// Visits what the ray from the origin may meet at a parameter below *first, which the visitor lowers.
  template <class Visit>
  void Along(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double* first,
             Visit&& visit) const {
    const Eigen::Array3d inverse = direction_W.array().inverse();
    const Eigen::Array3d origin = origin_W.array();
    const auto entry = [&](const Bounds& bounds) {
      const Eigen::Array3d to_min = (bounds.min.array() - origin) * inverse;
      const Eigen::Array3d to_max = (bounds.max.array() - origin) * inverse;
      double enter = 0.0, leave = kNever;
      for (int axis = 0; axis < 3; ++axis) {  // no number, along a face, cuts nothing
        enter = std::max(enter, std::min(to_min[axis], to_max[axis]));
        leave = std::min(leave, std::max(to_min[axis], to_max[axis]));
      }
      return enter <= leave ? enter : kNever;
    };
    Search(entry, first, visit);
  }

  /// Visits what overlaps the place.
  template <class Visit>
  void Within(const Bounds& place, Visit&& visit) const {
    double open = 1.0;
    Search([&](const Bounds& bounds) { return bounds.Overlaps(place) ? 0.0 : kNever; }, &open,
           visit);
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr int kDeepest = 64;  // halving, of no more things than a memory holds

  struct Node {
    Bounds bounds;
    int second = 0;  ///< index of the second child; the first one follows its parent
    int first = 0;   ///< of a leaf's things in order_
    int count = 0;   ///< of them; 0: no leaf
  };

  int Build(const std::vector<Bounds>& things, int first, int last);

  // Nearer children first; `key` is a lower bound of what a visitor can find.
  template <class Key, class Visit>
  void Search(const Key& key, double* best, Visit&& visit) const {
    if (nodes_.empty()) return;
    struct Open {
      int node;
      double key;
    };
    std::array<Open, kDeepest> open;
    std::size_t size = 0;
    open[size++] = {0, key(nodes_[0].bounds)};
    while (size > 0) {
      const Open at = open[--size];
      if (!(at.key < *best)) continue;
      const Node& node = nodes_[static_cast<std::size_t>(at.node)];
      if (node.count > 0) {
        for (int i = node.first; i < node.first + node.count; ++i) {
          visit(order_[static_cast<std::size_t>(i)]);
        }
        continue;
      }
      Open near{at.node + 1, key(nodes_[static_cast<std::size_t>(at.node) + 1].bounds)};
      Open far{node.second, key(nodes_[static_cast<std::size_t>(node.second)].bounds)};
      if (far.key < near.key) std::swap(near, far);
      if (far.key < *best) open[size++] = far;
      if (near.key < *best) open[size++] = near;
    }
  }

  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace touchdown::sim
