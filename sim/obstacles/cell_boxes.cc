// SPDX-License-Identifier: BSD-3-Clause
// Cells in a row along x become one bar. Bars of the same length side by side along y become one plate. Plates of the
// same shape one above the other become one box. Each step joins what follows it in order.
#include <algorithm>
#include <tuple>

#include <Eigen/Geometry>

#include "sim/obstacles/world_files.h"

namespace touchdown::sim {
namespace {

struct Block {
  Eigen::Vector3i low, high;  // its cells are [low, high)
};

// Joins blocks that are the same across `axis` and follow one another along it.
void Join(int axis, std::vector<Block>* blocks) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const auto across = [&](const Block& k) {
    return std::tuple(k.low[a], k.high[a], k.low[b], k.high[b]);
  };
  std::sort(blocks->begin(), blocks->end(), [&](const Block& left, const Block& right) {
    return std::pair(across(left), left.low[axis]) < std::pair(across(right), right.low[axis]);
  });
  std::vector<Block> joined;
  for (const Block& block : *blocks) {
    const bool follows = !joined.empty() && across(joined.back()) == across(block) &&
                         joined.back().high[axis] >= block.low[axis];
    if (follows) {
      joined.back().high[axis] = std::max(joined.back().high[axis], block.high[axis]);
    } else {
      joined.push_back(block);
    }
  }
  blocks->swap(joined);
}

}  // namespace

std::vector<Obstacle> BoxesOfCells(std::vector<Eigen::Vector3i> cells, double side,
                                   const Eigen::Vector3d& p_WF, double yaw) {
  std::vector<Block> blocks;
  blocks.reserve(cells.size());
  for (const Eigen::Vector3i& cell : cells) blocks.push_back({cell, cell.array() + 1});
  for (int axis = 0; axis < 3; ++axis) Join(axis, &blocks);
  const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
  std::vector<Obstacle> boxes;
  boxes.reserve(blocks.size());
  for (const Block& block : blocks) {
    Box box;
    box.center = p_WF + turn * (0.5 * side * (block.low + block.high).cast<double>());
    box.half_extents = 0.5 * side * (block.high - block.low).cast<double>();
    box.yaw = yaw;
    boxes.emplace_back(box);
  }
  return boxes;
}

}  // namespace touchdown::sim
