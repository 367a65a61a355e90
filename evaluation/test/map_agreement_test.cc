// SPDX-License-Identifier: BSD-3-Clause
// The rolling map against octomap::OcTree::insertPointCloud on the same depth frames.

#include <gtest/gtest.h>

#include "touchdown/evaluation/bench/map_flight.h"

namespace touchdown::evaluation {
namespace {

TEST(MapAgreement, AsOctomapInNinetyNineOfAHundredCells) {
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
      const Agreement agreement = Compare(map, tree);
      EXPECT_GT(agreement.observed, 100000);
      EXPECT_GE(agreement.share(), 0.99) << flight.name << ", " << 80 * scale << " pixels wide";
      RecordProperty(flight.name + std::to_string(80 * scale), std::to_string(agreement.share()));
    }
  }
}

}  // namespace
}  // namespace touchdown::evaluation
