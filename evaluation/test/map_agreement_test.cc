// SPDX-License-Identifier: BSD-3-Clause
// The rolling map against octomap::OcTree::insertPointCloud on the same depth frames.

#include <gtest/gtest.h>

#include "evaluation/bench/map_flight.h"

namespace touchdown::evaluation {
namespace {

/// Cells that a map calls free or occupied.
struct Cells {
  int either = 0;          ///< observed by one of the two
  int equal = 0;           ///< both occupied, or both observed and not occupied
  int free = 0;            ///< that the rolling map observed free ...
  int free_in_both = 0;    ///< ... and OctoMap too
  int occupied = 0;        ///< in OctoMap ...
  int free_here_only = 0;  ///< ... but observed free in the rolling map
};

Cells Count(const planning::OccupancyMap& map, const octomap::OcTree& tree) {
  Cells cells;
  planning::ForEachCell({map.origin(), map.origin() + map.size()},
                        [&](const planning::CellIndex& cell) {
                          const Eigen::Vector3d p = map.CentreOf(cell);
                          const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
                          const bool known = map.IsKnown(cell), in_tree = node != nullptr;
                          if (!known && !in_tree) return;
                          const bool occupied = in_tree && tree.isNodeOccupied(node);
                          const bool free = map.IsObservedFree(cell);
                          cells.either += 1;
                          cells.equal += known && in_tree && map.IsOccupied(cell) == occupied;
                          cells.free += free;
                          cells.free_in_both += free && in_tree && !occupied;
                          cells.occupied += occupied;
                          cells.free_here_only += free && occupied;
                        });
  return cells;
}

// The rolling map frees less than OctoMap by design. A ray frees cells only where options.thinnest_obstacle would be
// seen, and only a look from nearer clears a hit. Whatever it frees OctoMap frees too, except for the cells that
// two ways of walking along a ray take differently.
TEST(MapAgreement, WhatItFreesOctomapFreesToo) {
  for (const MapFlight& flight : {StraightTurnFlight(), ForestFlight()}) {
    for (const int scale : {1, 2}) {
      planning::OccupancyMap map(EqualOptions());
      octomap::OcTree tree = EqualTree(map.options());
      const auto frames = DepthFrames(flight, 80 * scale, 60 * scale, 1.5);
      ASSERT_GE(frames.size(), 5u);
      map.Recentre(frames[frames.size() / 2].p_WC);
      for (const estimation::DepthFrame& frame : frames) {
        map.Integrate(frame, {});
        tree.insertPointCloud(CloudOf(frame), OriginOf(frame), frame.max_range);
      }
      const Cells cells = Count(map, tree);
      SCOPED_TRACE(flight.name + ", " + std::to_string(80 * scale) + " pixels wide");
      EXPECT_GT(cells.free, 50000);
      EXPECT_LT(cells.free, cells.either);
      EXPECT_GE(cells.free_in_both, 0.999 * cells.free);
      EXPECT_LE(cells.free_here_only, 0.01 * cells.occupied);
      RecordProperty("free" + std::to_string(80 * scale) + flight.name, cells.free);
    }
  }
}

// With pixels that resolve everything, the maps differ only in how they count hits: here one hit
// wins.
TEST(MapAgreement, AsOctomapInNinetyNineOfAHundredCellsWhereAllIsResolved) {
  for (const MapFlight& flight : {StraightTurnFlight(), ForestFlight()}) {
    for (const int scale : {1, 2}) {
      planning::OccupancyMapOptions options = EqualOptions();
      options.thinnest_obstacle = 1e3;
      planning::OccupancyMap map(options);
      octomap::OcTree tree = EqualTree(map.options());
      const auto frames = DepthFrames(flight, 80 * scale, 60 * scale, 1.5);
      map.Recentre(frames[frames.size() / 2].p_WC);
      for (const estimation::DepthFrame& frame : frames) {
        map.Integrate(frame, {});
        tree.insertPointCloud(CloudOf(frame), OriginOf(frame), frame.max_range);
      }
      const Cells cells = Count(map, tree);
      EXPECT_GT(cells.either, 100000);
      EXPECT_GE(cells.equal, 0.99 * cells.either)
          << flight.name << ", " << 80 * scale << " pixels wide";
    }
  }
}

}  // namespace
}  // namespace touchdown::evaluation
