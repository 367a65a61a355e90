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
};

/// A tree of axis-aligned bounds. It finds the things near a point, along a ray or within bounds, each in time about
/// logarithmic in their number. A visitor gets a thing's index; what it finds shortens the search. No search allocates.
class BoundsTree {
 public:
  BoundsTree() = default;
  explicit BoundsTree(const std::vector<Bounds>& things);

  /// Visits what may have a signed distance to the point below *nearest [m], which the visitor lowers.
  template <class Visit>
  void Near(const Eigen::Vector3d& p_W, double* nearest, Visit&& visit) const {
    // Of all that lies in bounds, no signed distance is less than that of the bounds.
    const auto distance = [&](const Pair& pair) -> Two {
      Two outside = Two::Zero(), inside = Two::Constant(-kNever);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double p = p_W[static_cast<int>(axis)];
        const Two beyond = (pair.min[axis] - p).max(p - pair.max[axis]);
        outside += beyond.max(0.0).square();
        inside = inside.max(beyond);
      }
      return outside.sqrt() + inside.min(0.0);
    };
    Search(distance, nearest, [&](int place) { visit(ThingAt(place)); });
  }

  /// Visits what the ray from the origin may meet at a parameter below *first, which the visitor lowers.
  template <class Visit>
  void Along(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double* first,
             Visit&& visit) const {
    AlongPlaces(origin_W, direction_W, first, [&](int place) { visit(ThingAt(place)); });
  }
  /// The same with the thing's place in order().
  template <class Visit>
  void AlongPlaces(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                   double* first, Visit&& visit) const {
    const Eigen::Vector3d inverse = direction_W.cwiseInverse();
    const auto entry = [&](const Pair& pair) -> Two {
      Two enter = Two::Zero(), leave = Two::Constant(*first);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double from = origin_W[static_cast<int>(axis)];
        const Two to_min = (pair.min[axis] - from) * inverse[static_cast<int>(axis)];
        const Two to_max = (pair.max[axis] - from) * inverse[static_cast<int>(axis)];
        enter = enter.max(to_min.min(to_max));
        leave = leave.min(to_min.max(to_max));
      }
      return (enter <= leave).select(enter, kNever);
    };
    Search(entry, first, visit);
  }

  /// Visits what overlaps the place, and a few that are near to such.
  template <class Visit>
  void Within(const Bounds& place, Visit&& visit) const {
    PlacesWithin(place, [&](int at) { visit(ThingAt(at)); });
  }
  /// The same with the thing's place in order().
  template <class Visit>
  void PlacesWithin(const Bounds& place, Visit&& visit) const {
    const auto apart = [&](const Pair& pair) -> Two {
      Two gap = Two::Constant(-kNever);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int i = static_cast<int>(axis);
        gap = gap.max(pair.min[axis] - place.max[i]).max(place.min[i] - pair.max[axis]);
      }
      return gap;
    };
    double touching = std::numeric_limits<double>::min();  // a gap of zero width is no gap
    Search(apart, &touching, visit);
  }

  /// The things in the order of the tree: what lies side by side is near to each other.
  const std::vector<int>& order() const { return order_; }

 private:
  using Two = Eigen::Array2d;  // of both children at once
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kDeepest = 64;  // halving, of no more things than a memory holds

  struct Pair {
    std::array<Two, 3> min, max;  ///< by axis
  };
  /// A part of the tree: a node, or things.
  struct Child {
    int first = 0;   ///< index of the node, or place in order_ of the first of the things
    int count = -1;  ///< of the things; -1: a node
  };
  struct Node {
    Pair bounds;
    std::array<Child, 2> children;
  };

  Child Build(const std::vector<Bounds>& things, int first, int last);
  int ThingAt(int place) const { return order_[static_cast<std::size_t>(place)]; }

  // Nearer children first; `key` is a lower bound of what a visitor can find.
  template <class Key, class Visit>
  void Search(const Key& key, double* best, Visit&& visit) const {
    if (nodes_.empty()) return;
    struct Open {
      Child child;
      double key;
    };
    std::array<Open, kDeepest> open;
    std::size_t size = 0;
    open[size++] = {root_, -kNever};
    while (size > 0) {
      const Open at = open[--size];
      if (!(at.key < *best)) continue;
      if (at.child.count >= 0) {
        for (int i = 0; i < at.child.count; ++i) visit(at.child.first + i);
        continue;
      }
      const Node& node = nodes_[static_cast<std::size_t>(at.child.first)];
      const Two keys = key(node.bounds);
      const std::size_t near = keys[1] < keys[0] ? 1 : 0, far = 1 - near;
      if (keys[static_cast<int>(far)] < *best) {
        open[size++] = {node.children[far], keys[static_cast<int>(far)]};
      }
      if (keys[static_cast<int>(near)] < *best) {
        open[size++] = {node.children[near], keys[static_cast<int>(near)]};
      }
    }
  }

  std::vector<Node> nodes_;
  std::vector<int> order_;
  Child root_;
};

}  // namespace touchdown::sim
