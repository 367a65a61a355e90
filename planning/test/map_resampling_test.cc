// SPDX-License-Identifier: BSD-3-Clause
// Files whose cells are not the map's. The result of reading is compared with the rule, applied to
// every leaf. Also what a flight found of a file.

#include <cmath>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include "planning/test/planning_fixtures.h"
#include "touchdown/planning/map/persistent_map.h"

namespace touchdown::planning {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Leaf {
  Eigen::Array3d low, high;  // [m]
  double log_odds;
};

/// Blobs of free and occupied cells about the origin, some of them joined to large leaves.
octomap::OcTree RandomTree(double resolution, unsigned seed) {
  octomap::OcTree tree(resolution);
  Draw draw(seed);
  for (int i = 0; i < 60; ++i) {
    const float log_odds = i % 3 == 0   ? 1.5f
                           : i % 3 == 1 ? -1.0f
                                        : 0.1f * static_cast<float>(i % 7);
    CellIndex low, high;
    for (int c = 0; c < 3; ++c) {
      low[c] = static_cast<int>(std::floor(draw.Uniform(-1.5, 1.2) / resolution));
      high[c] = low[c] + 1 + static_cast<int>(draw.Uniform(0.0, 0.6) / resolution);
    }
    ForEachCell({low, high}, [&](const CellIndex& cell) {
      const auto key = [](int k) { return static_cast<octomap::key_type>(k + 32768); };
      tree.setNodeValue(octomap::OcTreeKey(key(cell.x()), key(cell.y()), key(cell.z())), log_odds);
    });
  }
  tree.prune();
  return tree;
}

std::vector<Leaf> LeavesOf(const octomap::OcTree& tree) {
  std::vector<Leaf> leaves;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const int side = 1 << (16 - leaf.getDepth());
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const Eigen::Array3d low = Eigen::Array3d(key[0], key[1], key[2]) - 32768.0;
    leaves.push_back(
        {low * tree.getResolution(), (low + side) * tree.getResolution(), leaf->getLogOdds()});
  }
  return leaves;
}

/// The rule, applied to every leaf.
CellState StateOf(const std::vector<Leaf>& leaves, const CellIndex& cell, double side) {
  const Eigen::Array3d low = side * cell.cast<double>().array(), high = low + side;
  const Eigen::Array3d middle = low + 0.5 * side;
  bool free = false;
  for (const Leaf& leaf : leaves) {
    const Eigen::Array3d shared = leaf.high.min(high) - leaf.low.max(low);
    if (leaf.log_odds >= 0.375 && (shared > 2e-3 * side).all()) return CellState::kOccupied;
    // On a face it is in the upper one.
    free |= leaf.log_odds < -0.05 && (middle > leaf.low - 1e-9).all() &&
            (middle < leaf.high - 1e-9).all();
  }
  return free ? CellState::kFree : CellState::kUnknown;
}

PersistentMap ReadFrom(octomap::OcTree* tree, bool binary = false) {
  std::stringstream file;
  binary ? tree->writeBinary(file) : tree->write(file);
  PersistentMap map{OccupancyMapOptions{}};
  map.Read(file);
  return map;
}

TEST(MapResampling, KeepsTheRuleInEveryCell) {
  for (const double resolution : {0.05, 0.08, 0.2, 0.25, 0.37}) {
    SCOPED_TRACE(resolution);
    octomap::OcTree tree = RandomTree(resolution, 7);
    const std::vector<Leaf> leaves = LeavesOf(tree);
    const PersistentMap map = ReadFrom(&tree);
    int occupied = 0, free = 0;
    ForEachCell({{-20, -20, -20}, {24, 24, 24}}, [&](const CellIndex& cell) {
      const auto log_odds = map.LogOdds(cell);
      const CellState state = !log_odds              ? CellState::kUnknown
                              : map.IsOccupied(cell) ? CellState::kOccupied
                                                     : CellState::kFree;
      ASSERT_EQ(state, StateOf(leaves, cell, 0.1)) << cell.transpose();
      ASSERT_FALSE(state == CellState::kFree && *log_odds >= 0);
      occupied += state == CellState::kOccupied;
      free += state == CellState::kFree;
    });
    EXPECT_GT(occupied, 200);
    EXPECT_GT(free, 200);
  }
}

// Twice as fine, and every other cell's face on one of the map's: nothing grows beyond its face.
TEST(MapResampling, FacesThatTouchDoNotCount) {
  for (const double resolution : {0.05, 0.2}) {
    octomap::OcTree tree(resolution);
    for (double x = 1.0; x < 1.4; x += resolution) {
      tree.updateNode(x + 0.5 * resolution, 0.5 * resolution, 1.0 + 0.5 * resolution, true);
    }
    const PersistentMap map = ReadFrom(&tree, true);
    const int high = resolution < 0.1 ? 1 : 2;
    int occupied = 0;
    ForEachCell({{0, -10, 0}, {30, 20, 30}}, [&](const CellIndex& cell) {
      const bool in = cell.x() >= 10 && cell.x() < 14 && cell.y() >= 0 && cell.y() < high &&
                      cell.z() >= 10 && cell.z() < 10 + high;
      EXPECT_EQ(map.IsOccupied(cell), in) << cell.transpose();
      occupied += in;
    });
    EXPECT_EQ(occupied, 4 * high * high);
    EXPECT_EQ(map.CheckPrior().occupied, occupied);
  }
}

// Two million cells of the map, of which only the borders cost anything.
TEST(MapResampling, LargeFreeSpaceIsCheap) {
  octomap::OcTree tree(0.2);
  const auto key = [](int k) { return static_cast<octomap::key_type>(k + 32768); };
  ForEachCell({{0, 0, 0}, {64, 64, 64}}, [&](const CellIndex& cell) {
    tree.setNodeValue(octomap::OcTreeKey(key(cell.x()), key(cell.y()), key(cell.z())), -1.0f, true);
  });
  tree.updateInnerOccupancy();
  tree.prune();
  const PersistentMap map = ReadFrom(&tree);
  EXPECT_LT(map.size(), 40u);
  EXPECT_LT(map.LogOdds({127, 0, 64}).value_or(0), 0);
  EXPECT_FALSE(map.LogOdds({128, 0, 64}).has_value());
}

TEST(MapResampling, RefusesWhatWouldTakeTooMuch) {
  octomap::OcTree tree(99.97);
  tree.updateNode(1.0, 1.0, 1.0, true);
  std::stringstream file;
  tree.writeBinary(file);
  PersistentMap map{OccupancyMapOptions{}};
  try {
    map.Read(file);
    FAIL() << "it was read";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("more than five million leaves; crop the file"));
  }
  EXPECT_EQ(map.size(), 0u);
}

/// A file with a wall at x = 2 m, in cells of 0.2 m, and free space before it.
octomap::OcTree Wall() {
  octomap::OcTree tree(0.2);
  for (double x = 0.1; x < 2.2; x += 0.2) {
    for (double y = -0.9; y < 1.0; y += 0.2) {
      for (double z = 0.1; z < 1.0; z += 0.2) tree.updateNode(x, y, z, x > 2.0);
    }
  }
  return tree;
}

TEST(PriorCheck, CountsWhatWasSensedSince) {
  octomap::OcTree tree = Wall();
  PersistentMap memory = ReadFrom(&tree, true);
  OccupancyMap map{OccupancyMapOptions{}};
  memory.Refill(&map);
  EXPECT_TRUE(map.IsBlocked(CellIndex(20, 0, 5)));
  EXPECT_EQ(map.CountObservedFree(), 0);  // no stop may use what the file holds free
  memory.Flush(&map);
  PriorCheck check = memory.CheckPrior();
  EXPECT_EQ(check.occupied, 2 * 20 * 9);  // the lowest cells are ground
  EXPECT_EQ(check.looked_at, 0);          // a file is not compared with itself
  map.SetState({20, 0, 5}, CellState::kFree);
  map.SetState({20, 1, 5}, CellState::kOccupied);
  map.SetState({20, 2, 0}, CellState::kFree);  // ground
  map.SetState({12, 0, 5}, CellState::kOccupied);
  map.SetState({12, 0, 0}, CellState::kOccupied);  // ground
  map.SetState({19, 5, 5},
               CellState::kOccupied);  // of the wall's face: at the border of free space
  map.SetState({18, 0, 5}, CellState::kOccupied);
  map.SetState({12, 5, 5}, CellState::kFree);      // as it says
  map.SetState({40, 0, 5}, CellState::kOccupied);  // it says nothing there
  map.SetState({20, 4, 5}, CellState::kFree);
  memory.Recentre({30.0, 0.0, 1.0}, &map);  // all of it leaves the window, and comes back
  memory.Recentre({0.0, 0.0, 1.0}, &map);
  map.SetState({20, 4, 5}, CellState::kOccupied);  // the latest look counts
  memory.Flush(&map);
  check = memory.CheckPrior();
  EXPECT_EQ(check.looked_at, 3);
  EXPECT_THAT(check.gone, ElementsAre(CellIndex(20, 0, 5)));
  EXPECT_THAT(check.appeared, ElementsAre(CellIndex(12, 0, 5), CellIndex(18, 0, 5)));
}

TEST(PriorCheck, ObstaclesNearABox) {
  octomap::OcTree tree = Wall();
  const PersistentMap memory = ReadFrom(&tree, true);
  std::int64_t cells = 0;
  for (const CellCube& cube : memory.PriorObstacles({{0, 0, 0}, {30, 2, 10}})) {
    cells += std::int64_t{cube.side} * cube.side * cube.side;
  }
  EXPECT_EQ(cells, 2 * 2 * 10);
  EXPECT_TRUE(memory.PriorObstacles({{0, 0, 0}, {20, 20, 10}}).empty());
}

}  // namespace
}  // namespace touchdown::planning
