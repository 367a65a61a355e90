// SPDX-License-Identifier: BSD-3-Clause
// Halved at the median of the centres along the longest side, until few are left. The bounds are a little wider than
// their content, so that rounding does not lose what just touches.
#include "sim/obstacles/bounds_tree.h"

#include <numeric>

namespace touchdown::sim {
namespace {

constexpr int kLeaf = 4;         // things that are halved no more
constexpr double kWider = 1e-9;  // [m], and of the coordinate

Bounds Union(const std::vector<Bounds>& things, const std::vector<int>& order, int first,
             int last) {
  Bounds all{Eigen::Vector3d::Constant(1e300), Eigen::Vector3d::Constant(-1e300)};
  for (int i = first; i < last; ++i) {
    const Bounds& thing = things[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    all.min = all.min.cwiseMin(thing.min);
    all.max = all.max.cwiseMax(thing.max);
  }
  const Eigen::Array3d wider = kWider * (1.0 + all.min.array().abs().max(all.max.array().abs()));
  return {all.min.array() - wider, all.max.array() + wider};
}

}  // namespace

BoundsTree::BoundsTree(const std::vector<Bounds>& things) : order_(things.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (things.empty()) return;
  nodes_.reserve(things.size() / 2 + 1);
  root_ = Build(things, 0, static_cast<int>(things.size()));
  if (nodes_.empty()) nodes_.emplace_back();  // not empty, only small
}

BoundsTree::Child BoundsTree::Build(const std::vector<Bounds>& things, int first, int last) {
  if (last - first <= kLeaf) return {first, last - first};
  const Bounds all = Union(things, order_, first, last);
  int axis = 0;
  (all.max - all.min).maxCoeff(&axis);
  const auto centre = [&](int thing) {
    const Bounds& bounds = things[static_cast<std::size_t>(thing)];
    return bounds.min[axis] + bounds.max[axis];
  };
  const int middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](int a, int b) {
                     return centre(a) < centre(b) || (centre(a) == centre(b) && a < b);
                   });
  const auto index = nodes_.size();
  nodes_.emplace_back();
  const std::array<Bounds, 2> halves = {Union(things, order_, first, middle),
                                        Union(things, order_, middle, last)};
  for (std::size_t i = 0; i < 3; ++i) {
    const int c = static_cast<int>(i);
    nodes_[index].bounds.min[i] = {halves[0].min[c], halves[1].min[c]};
    nodes_[index].bounds.max[i] = {halves[0].max[c], halves[1].max[c]};
  }
  const Child one = Build(things, first, middle), other = Build(things, middle, last);
  nodes_[index].children = {one, other};
  return {static_cast<int>(index), -1};
}

}  // namespace touchdown::sim
