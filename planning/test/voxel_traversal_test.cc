// SPDX-License-Identifier: BSD-3-Clause
// Voxel traversal against dense sampling.

#include "planning/map/voxel_traversal.h"

#include <gtest/gtest.h>

#include <set>

#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

TEST(TraverseCells, VisitsEveryCellThatSamplingFinds) {
  Draw draw(21);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d a = draw.Vector(2.0), b = draw.Vector(2.0);
    std::set<std::array<int, 3>> visited;
    CellIndex previous;
    bool first = true, connected = true;
    EXPECT_TRUE(TraverseCells(a, b, 0.1, [&](const CellIndex& cell) {
      if (!first) connected = connected && (cell - previous).cwiseAbs().sum() == 1;
      first = false;
      previous = cell;
      visited.insert({cell.x(), cell.y(), cell.z()});
      return true;
    }));
    EXPECT_TRUE(connected);
    for (double s = 0.0; s <= 1.0; s += 0.001) {
      const CellIndex c = ((a + s * (b - a)) / 0.1).array().floor().matrix().cast<int>();
      EXPECT_TRUE(visited.count({c.x(), c.y(), c.z()})) << "trial " << trial << " s " << s;
    }
  }
}

TEST(TraverseCells, EndsOnLatticeFacesAndInOneCell) {
  int cells = 0;
  const auto count = [&](const CellIndex&) { return ++cells < 100; };
  EXPECT_TRUE(TraverseCells({0.05, 0.05, 0.05}, {0.05, 0.05, 0.05}, 0.1, count));
  EXPECT_EQ(cells, 1);
  cells = 0;
  EXPECT_TRUE(TraverseCells({0.0, 0.0, 0.0}, {0.375, 0.375, 0.375}, 0.125, count));
  EXPECT_EQ(cells, 10);
}

}  // namespace
}  // namespace touchdown::planning
