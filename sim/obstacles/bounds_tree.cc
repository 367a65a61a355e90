// SPDX-License-Identifier: BSD-3-Clause
// Halved at the median of the centres along the longest side, until few are left. A little wider than what they hold:
// a rounding must not lose what just touches.
#include "sim/obstacles/bounds_tree.h"

#include <numeric>

namespace touchdown::sim {
namespace {

constexpr int kLeaf = 4;          // things in a leaf, at most
constexpr double kWider = 1e-9;   // [m], and of the coordinate

Bounds Union(const std::vector<Bounds>& things, const std::vector<int>& order, int first,
             int last) {
  Bounds all = things[static_cast<std::size_t>(order[static_cast<std::size_t>(first)])];
  for (int i = first + 1; i < last; ++i) {
    const Bounds& thing = things[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    all.min = all.min.cwiseMin(thing.min);
    all.max = all.max.cwiseMax(thing.max);
  }
  const Eigen::Array3d wider = kWider * (1.0 + all.min.array().abs().max(all.max.array().abs()));
  all.min.array() -= wider;
  all.max.array() += wider;
  return all;
}

}  // namespace

BoundsTree::BoundsTree(const std::vector<Bounds>& things) : order_(things.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (things.empty()) return;
  nodes_.reserve(2 * things.size() / kLeaf + 1);
  Build(things, 0, static_cast<int>(things.size()));
}

int BoundsTree::Build(const std::vector<Bounds>& things, int first, int last) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({Union(things, order_, first, last), 0, first, last - first});
  if (last - first <= kLeaf) return index;
  int axis = 0;
  (nodes_.back().bounds.max - nodes_.back().bounds.min).maxCoeff(&axis);
  const auto centre = [&](int thing) {
    const Bounds& bounds = things[static_cast<std::size_t>(thing)];
    return bounds.min[axis] + bounds.max[axis];
  };
  const int middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](int a, int b) {
                     return centre(a) < centre(b) || (centre(a) == centre(b) && a < b);
                   });
  Build(things, first, middle);
  const int second = Build(things, middle, last);
  nodes_[static_cast<std::size_t>(index)].second = second;
  nodes_[static_cast<std::size_t>(index)].count = 0;
  return index;
}

}  // namespace touchdown::sim
