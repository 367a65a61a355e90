// SPDX-License-Identifier: BSD-3-Clause
// The persistent map loses nothing when the window moves, and keeps nothing that moved on. octomap
// itself reads and writes the same files.

#include "touchdown/planning/map/persistent_map.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/octomap.h>

#include "planning/test/planning_fixtures.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

using ::testing::HasSubstr;

const Eigen::Vector3d kEye(0.05, 0.05, 0.85);

OccupancyMapOptions SmallMap() {
  OccupancyMapOptions options;
  options.size_log2 = {6, 6, 4};
  options.inflation_radius = 0.2;
  return options;
}

/// The image of a camera at `eye` that looks along +x. It sees a wall 2.4 m from kEye and a post of
/// 0.4 m width at `post` = (x, y), from the ground up. NaN: no post.
estimation::DepthFrame Scene(const Eigen::Vector2d& post, const Eigen::Vector3d& eye = kEye) {
  estimation::DepthFrame frame;
  frame.p_WC = eye;
  frame.R_WC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const double right = (u + 0.5 - k.cx) / k.focal;
      const double to_post = post.x() - eye.x(), to_wall = kEye.x() + 2.4 - eye.x();
      const double y = eye.y() - to_post * right;
      frame.depth.push_back(static_cast<float>(std::abs(y - post.y()) < 0.2 ? to_post : to_wall));
    }
  }
  return frame;
}

const Eigen::Vector3d kNearer = kEye + Eigen::Vector3d(0.5, 0.0, 0.0);
const Eigen::Vector2d kNoPost = Eigen::Vector2d::Constant(std::nan(""));

template <class Visit>
void ForEachInWindow(const OccupancyMap& map, Visit&& visit) {
  ForEachCell({map.origin(), map.origin() + map.size()}, visit);
}

/// Cells of the window in which two maps differ.
int Differences(const OccupancyMap& a, const OccupancyMap& b) {
  int count = 0;
  ForEachInWindow(a, [&](const CellIndex& cell) {
    count += a.IsKnown(cell) != b.IsKnown(cell) || a.IsOccupied(cell) != b.IsOccupied(cell) ||
             a.IsBlocked(cell) != b.IsBlocked(cell);
  });
  return count;
}

/// A map that has seen posts come and go.
OccupancyMap SeenMap() {
  OccupancyMap map(SmallMap());
  map.Recentre(kEye);
  for (const double y : {-0.6, 0.5}) map.Integrate(Scene({1.55, y}), {});
  return map;  // the first one has gone, and is unsure
}

TEST(PersistentMap, GivesBackWhatTheWindowForgot) {
  OccupancyMap map = SeenMap();
  const OccupancyMap before = map;
  PersistentMap kept(SmallMap());
  for (const Eigen::Vector3d& away :
       {Eigen::Vector3d(-3.0, 0.0, 0.0), Eigen::Vector3d(-2.0, 2.5, 0.4),
        Eigen::Vector3d(0.0, 0.0, -0.5)}) {
    kept.Recentre(kEye + away, &map);
    EXPECT_GT(Differences(before, map), 100);
    kept.Recentre(kEye, &map);
    EXPECT_EQ(Differences(before, map), 0);
  }
  const std::size_t size = kept.size();
  kept.Flush(&map);
  EXPECT_GT(kept.size(), size);  // what had never left
  ForEachInWindow(map, [&](const CellIndex& cell) {
    EXPECT_EQ(kept.LogOdds(cell).has_value(), map.IsKnown(cell));
    EXPECT_EQ(kept.IsOccupied(cell), map.IsOccupied(cell));
  });
}

// Before, every cell that left was a node of an octree: tens of thousands of allocations in one frame.
TEST(PersistentMap, DoesNotAllocateWhenTheWindowMoves) {
  OccupancyMap map = SeenMap();
  PersistentMap kept(SmallMap());
  const estimation::DepthFrame frame = Scene({1.55, 0.0});
  map.Integrate(frame, {});
  const CellIndex origin = map.origin();
  const long before = solvers::AllocationCount();
  for (const double away : {-4.0, 0.0, 0.0}) {
    kept.Recentre(kEye + Eigen::Vector3d(away, 0.0, 0.0), &map);
    map.Integrate(frame, {});
  }
  EXPECT_EQ(solvers::AllocationCount(), before);
  EXPECT_EQ(map.origin(), origin);  // it was away and came back
  EXPECT_GT(kept.size(), 1000u);
}

TEST(PersistentMap, AnObstacleThatHasGoneIsFreedInMemoryToo) {
  OccupancyMap map(SmallMap());
  PersistentMap kept(SmallMap());
  kept.Recentre(kEye, &map);
  map.Integrate(Scene({1.55, 0.0}), {});
  const CellIndex post = map.CellOf({1.56, 0.05, kEye.z()});
  EXPECT_TRUE(map.IsOccupied(post));
  // The window looks elsewhere: the post is stored as it stood there.
  kept.Recentre(kEye + Eigen::Vector3d(20.0, 0.0, 0.0), &map);
  EXPECT_TRUE(kept.IsOccupied(post));
  kept.Recentre(kEye, &map);
  for (int i = 0; i < 4; ++i) map.Integrate(Scene(kNoPost, kNearer), {});
  kept.Flush(&map);
  EXPECT_FALSE(map.IsOccupied(post));
  EXPECT_FALSE(kept.IsOccupied(post));
}

// Before, a remembered obstacle was freed by any ray through its cell, from any distance.
TEST(PersistentMap, ARememberedObstacleIsNotFreedFromAfar) {
  PersistentMap kept(SmallMap());
  OccupancyMap map(SmallMap());
  kept.Recentre(kEye, &map);
  map.SetOccupied({2.25, 0.05, kEye.z()});
  const CellIndex cell = map.CellOf({2.25, 0.05, kEye.z()});
  kept.Recentre(kEye + Eigen::Vector3d(20.0, 0.0, 0.0), &map);
  kept.Recentre(kEye, &map);
  ASSERT_TRUE(map.IsOccupied(cell));
  for (int i = 0; i < 20; ++i) map.Integrate(Scene(kNoPost), {});  // 2.2 m away: not sharp
  EXPECT_TRUE(map.IsOccupied(cell));
  for (int i = 0; i < 5; ++i) map.Integrate(Scene(kNoPost, kNearer), {});
  EXPECT_FALSE(map.IsOccupied(cell));
}

TEST(PersistentMap, MemoryIsNoObservation) {
  OccupancyMap map = SeenMap();
  PersistentMap kept(SmallMap());
  EXPECT_GT(map.CountObservedFree(), 1000);
  kept.Flush(&map);
  OccupancyMap refilled(SmallMap());
  refilled.Recentre(kEye);
  kept.Refill(&refilled);
  EXPECT_EQ(refilled.CountObservedFree(), 0);
}

TEST(PersistentMap, LogOddsFilesComeBackExactly) {
  OccupancyMap map = SeenMap();
  PersistentMap kept(SmallMap());
  kept.Flush(&map);
  std::stringstream file;
  kept.Write(file, MapFormat::kLogOdds);
  PersistentMap again(SmallMap());
  again.Read(file);
  EXPECT_EQ(again.size(), kept.size());
  int known = 0;
  ForEachInWindow(map, [&](const CellIndex& cell) {
    EXPECT_EQ(again.LogOdds(cell), kept.LogOdds(cell));
    known += again.LogOdds(cell).has_value();
  });
  EXPECT_GT(known, 3000);
  OccupancyMap refilled(SmallMap());
  refilled.Recentre(kEye);
  again.Refill(&refilled);
  EXPECT_EQ(Differences(map, refilled), 0);
}

TEST(PersistentMap, BinaryFilesHoldWhatIsSure) {
  OccupancyMap map = SeenMap();
  PersistentMap kept(SmallMap());
  kept.Flush(&map);
  std::stringstream file;
  kept.Write(file, MapFormat::kBinary);
  PersistentMap again(SmallMap());
  again.Read(file);
  OccupancyMap refilled(SmallMap());
  refilled.Recentre(kEye);
  again.Refill(&refilled);
  int unsure = 0;
  ForEachInWindow(map, [&](const CellIndex& cell) {
    EXPECT_EQ(refilled.IsOccupied(cell), map.IsOccupied(cell));
    const bool is_unsure = map.IsKnown(cell) && !map.IsOccupied(cell) && !map.IsObservedFree(cell);
    EXPECT_EQ(refilled.IsKnown(cell), map.IsKnown(cell) && !is_unsure);
    unsure += is_unsure;
  });
  EXPECT_GT(unsure, 0);  // there were such cells to leave out
}

TEST(PersistentMap, ABinaryFileLeavesOutWholeGroupsThatAreUnsure) {
  octomap::OcTree tree(0.1);
  for (int i = 0; i < 64; ++i) {
    const auto at = [&](int shift) { return 0.05 + 0.1 * (i >> shift & 3); };
    tree.setNodeValue(at(0), at(2), at(4), 0.1f * static_cast<float>(i % 2), true);
  }
  tree.setNodeValue(0.85, 0.05, 0.05, 2.0f);
  std::stringstream log_odds, binary;
  tree.write(log_odds);
  PersistentMap kept(SmallMap());
  kept.Read(log_odds);
  EXPECT_TRUE(kept.LogOdds({0, 0, 0}).has_value());
  kept.Write(binary, MapFormat::kBinary);
  kept.Read(binary);
  EXPECT_FALSE(kept.LogOdds({0, 0, 0}).has_value());
  EXPECT_TRUE(kept.IsOccupied({8, 0, 0}));
}

TEST(PersistentMap, AnEmptyMapIsAFileToo) {
  for (const MapFormat format : {MapFormat::kLogOdds, MapFormat::kBinary}) {
    std::stringstream file;
    PersistentMap(SmallMap()).Write(file, format);
    PersistentMap again(SmallMap());
    again.Read(file);
    EXPECT_EQ(again.LogOdds({0, 0, 0}), std::nullopt);
  }
}

TEST(PersistentMap, OctomapReadsWhatIsWritten) {
  OccupancyMap map = SeenMap();
  PersistentMap kept(SmallMap());
  kept.Flush(&map);
  const std::string name = ::testing::TempDir() + "touchdown_persistent_map";
  {
    std::ofstream log_odds(name + ".ot", std::ios::binary), binary(name + ".bt", std::ios::binary);
    kept.Write(log_odds, MapFormat::kLogOdds);
    kept.Write(binary, MapFormat::kBinary);
  }
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(name + ".ot"));
  const auto* tree = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  const octomap::OcTree binary_tree(name + ".bt");
  EXPECT_EQ(binary_tree.getResolution(), 0.1);
  ForEachInWindow(map, [&](const CellIndex& cell) {
    const Eigen::Vector3d p = map.CentreOf(cell);
    const octomap::OcTreeNode* node = tree->search(p.x(), p.y(), p.z());
    const octomap::OcTreeNode* bit = binary_tree.search(p.x(), p.y(), p.z());
    ASSERT_EQ(node != nullptr, map.IsKnown(cell));
    EXPECT_EQ(bit != nullptr, map.IsOccupied(cell) || map.IsObservedFree(cell));
    if (node != nullptr) {
      EXPECT_EQ(node->getOccupancy() >= 0.59, map.IsOccupied(cell));
    }
    if (bit != nullptr) {
      EXPECT_EQ(binary_tree.isNodeOccupied(bit), map.IsOccupied(cell));
    }
  });
  std::remove((name + ".ot").c_str());
  std::remove((name + ".bt").c_str());
}

/// A room that octomap mapped by itself, with its own probabilities; merged where it can be.
octomap::OcTree ForeignTree(double resolution) {
  octomap::OcTree tree(resolution);
  octomap::Pointcloud wall;
  for (float y = -2.0f; y < 2.0f; y += 0.04f) {
    for (float z = 0.2f; z < 2.0f; z += 0.04f) wall.push_back(2.05f, y, z);
  }
  for (int i = 0; i < 6; ++i) tree.insertPointCloud(wall, {0.05f, 0.05f, 0.85f});
  return tree;
}

TEST(PersistentMap, AForeignMapIsKnownSpace) {
  for (const bool binary : {false, true}) {
    octomap::OcTree tree = ForeignTree(0.1);
    std::stringstream file;
    binary ? tree.writeBinary(file) : tree.write(file);
    unsigned highest = 16;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
      highest = std::min(highest, leaf.getDepth());
    }
    EXPECT_LT(highest, 16u);  // there are merged leaves to expand
    PersistentMap kept(SmallMap());
    kept.Read(file);
    OccupancyMap map(SmallMap());
    kept.Recentre({0.6, 0.05, 0.85}, &map);
    kept.Refill(&map);
    int occupied = 0, free = 0;
    ForEachInWindow(map, [&](const CellIndex& cell) {
      const Eigen::Vector3d p = map.CentreOf(cell);
      const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
      EXPECT_EQ(map.IsKnown(cell), node != nullptr);
      if (node == nullptr) return;
      EXPECT_EQ(map.IsOccupied(cell), tree.isNodeOccupied(node));
      EXPECT_FALSE(map.IsObservedFree(cell));  // what others saw, this vehicle did not
      (tree.isNodeOccupied(node) ? occupied : free) += 1;
    });
    EXPECT_GT(occupied, 300);
    EXPECT_GT(free, 3000);
  }
}

std::string Refusal(const std::string& file) {
  PersistentMap kept(SmallMap());
  std::istringstream in(file);
  try {
    kept.Read(in);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(PersistentMap, RefusesWhatItCannotUseWithASentence) {
  EXPECT_THAT(Refusal(""), HasSubstr("it is no OctoMap file"));
  EXPECT_THAT(Refusal("solid cube\n"), HasSubstr("it is no OctoMap file"));
  EXPECT_THAT(Refusal("# Octomap OcTree file\nid OcTree\nsize 0\nres 0\ndata\n"),
              HasSubstr("its resolution is 0.0"));
  EXPECT_THAT(Refusal("# Octomap OcTree file\nid OcTree\nsize 16777217\nres 0.1\ndata\n"),
              HasSubstr("16777217 nodes; allowed are 16 million"));
  EXPECT_THAT(Refusal(std::string(kMostMapBytes + 1, '#')), HasSubstr("larger than the 128 MiB"));
  std::stringstream colour;
  octomap::ColorOcTree colours(0.1);
  colours.updateNode(0.0, 0.0, 0.0, true);
  colours.write(colour);
  EXPECT_THAT(Refusal(colour.str()), HasSubstr("type 'ColorOcTree'"));
}

TEST(PersistentMap, RefusesAFileThatIsCutShortOrMangled) {
  octomap::OcTree tree = ForeignTree(0.1);
  std::stringstream log_odds, binary;
  tree.write(log_odds);
  tree.writeBinary(binary);
  Draw draw(3);
  for (const std::string& file : {log_odds.str(), binary.str()}) {
    EXPECT_EQ(Refusal(file), "");
    for (std::size_t size = 0; size < file.size(); size += 1 + file.size() / 97) {
      EXPECT_NE(Refusal(file.substr(0, size)), "") << size;
    }
    EXPECT_THAT(Refusal(file + "x"), HasSubstr("behind its last node"));
    // Some changes make another map. The worst outcome allowed is a refusal.
    for (int i = 0; i < 200; ++i) {
      std::string mangled = file;
      mangled[static_cast<std::size_t>(draw.Uniform(0.0, 0.999) * file.size())] ^= 0x55;
      Refusal(mangled);
    }
  }
  std::string deep = "# Octomap OcTree file\nid OcTree\nsize 40\nres 0.1\ndata\n";
  for (int i = 0; i < 40; ++i) deep += std::string(4, '\0') + '\1';
  EXPECT_THAT(Refusal(deep), HasSubstr("deeper than 16 levels"));
}

// Seen cells replace read ones cell by cell, also where the file has eight of them in one.
TEST(PersistentMap, WhatWasReadAndWhatWasSeenAreOneMap) {
  octomap::OcTree tree(0.1);
  ForEachCell({{0, 0, 0}, {16, 16, 16}}, [&](const CellIndex& cell) {
    tree.setNodeValue(0.1 * cell.x() + 0.05, 0.1 * cell.y() + 0.05, 0.1 * cell.z() + 0.05, 2.0f);
  });
  tree.prune();
  std::stringstream read, written;
  tree.write(read);
  PersistentMap kept(SmallMap());
  kept.Read(read);
  EXPECT_EQ(kept.LogOdds({3, 3, 3}), 32);
  OccupancyMap map(SmallMap());
  map.SetState({3, 3, 3}, CellState::kFree);
  map.SetState({20, 3, 3}, CellState::kOccupied);
  kept.Flush(&map);
  kept.Write(written, MapFormat::kLogOdds);
  PersistentMap again(SmallMap());
  again.Read(written);
  for (const PersistentMap* either : {&kept, &again}) {
    EXPECT_EQ(either->LogOdds({3, 3, 3}), -32);
    EXPECT_TRUE(either->IsOccupied({20, 3, 3}));
    EXPECT_EQ(either->LogOdds({21, 3, 3}), std::nullopt);
    for (const CellIndex& cell : {CellIndex(2, 3, 3), CellIndex(0, 0, 0), CellIndex(15, 15, 15)}) {
      EXPECT_EQ(either->LogOdds(cell), 32);
    }
  }
}

TEST(PersistentMap, AFailedReadChangesNothing) {
  OccupancyMap map = SeenMap();
  PersistentMap kept(SmallMap());
  kept.Flush(&map);
  const std::size_t size = kept.size();
  std::istringstream bad("bad");
  EXPECT_THROW(kept.Read(bad), std::invalid_argument);
  EXPECT_EQ(kept.size(), size);
}

}  // namespace
}  // namespace touchdown::planning
