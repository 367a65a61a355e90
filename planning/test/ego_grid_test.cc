// SPDX-License-Identifier: BSD-3-Clause
#include "planning/baselines/ego/ego_grid.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace touchdown::planning {
namespace {

TEST(CubeGrid, GrowsObstaclesByCubesAndBlocksTheOutside) {
  CubeGrid grid({0, 0, -0.01}, {2, 2, 2}, 0.1, 0.3);
  grid.SetOccupied({1.05, 1.05, 1.05});
  EXPECT_TRUE(grid.Occupied({1.35, 1.35, 1.35}));
  EXPECT_FALSE(grid.Occupied({1.45, 1.05, 1.05}));
  EXPECT_TRUE(grid.Occupied({0.75, 0.75, 0.75}));
  EXPECT_FALSE(grid.Occupied({0.65, 1.05, 1.05}));
  EXPECT_TRUE(grid.Occupied({-0.1, 1, 1}));
  EXPECT_FALSE(grid.Inside({1, 1, -0.05}));
  EXPECT_THROW(CubeGrid({0, 0, 0}, {1, 1, 1}, 0.0, 0.1), std::invalid_argument);
  EXPECT_THROW(CubeGrid({0, 0, 0}, {1, 1, 1}, 0.1, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
