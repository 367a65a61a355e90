// SPDX-License-Identifier: BSD-3-Clause
#include "planning/baselines/ego/ego_search.h"

#include <vector>

#include <gtest/gtest.h>

#include "planning/test/ego_fixtures.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

TEST(EgoSearch, GoesAroundAndNamesItsFailures) {
  EgoOptions options;
  CubeGrid grid = EmptyGrid();
  AddBox({-0.3, -1, 0}, {0.3, 1, 3}, &grid);
  EgoSearch search(options);
  std::vector<Vector3d> path;
  ASSERT_EQ(search.Search(grid, {-1, 0, 1}, {1, 0, 1}, &path), EgoSearchStatus::kFound);
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_FALSE(grid.Occupied(path[i]));
    if (i > 0) {
      EXPECT_LT((path[i] - path[i - 1]).norm(), 0.18);
    }
  }
  EXPECT_LT((path.front() - Vector3d(-1, 0, 1)).norm(), 0.1);
  EXPECT_LT((path.back() - Vector3d(1, 0, 1)).norm(), 0.1);
  // An end inside the obstacle moves out of it, away from the other end.
  ASSERT_EQ(search.Search(grid, {0.1, 0, 1}, {1, 0, 1}, &path), EgoSearchStatus::kFound);
  EXPECT_LT(path.front().x(), -0.3);

  options.search_expansions = 10;
  EXPECT_EQ(EgoSearch(options).Search(grid, {-1, 0, 1}, {1, 0, 1}, &path),
            EgoSearchStatus::kExpansionLimit);
  EXPECT_EQ(search.Search(grid, {-9.5, 0, 1}, {9.5, 0, 1}, &path), EgoSearchStatus::kEndsTooFar);
  AddBox({-0.3, -10, 0}, {0.3, 10, 3}, &grid);
  EXPECT_EQ(search.Search(grid, {-1, 0, 1}, {1, 0, 1}, &path), EgoSearchStatus::kNoPath);
}

}  // namespace
}  // namespace touchdown::planning
