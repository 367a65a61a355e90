// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/span_search.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

constexpr int kEnough = 100000;
constexpr PathCost kPlain{2.0, 1.0};

/// Blocks the cells whose centres are in a box.
void Fill(OccupancyMap* map, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const CellIndex first = map->CellOf(low.array() + 0.05), end = map->CellOf(high.array() + 0.05);
  ForEachCell({first, end}, [&](const CellIndex& cell) { map->SetOccupied(map->CentreOf(cell)); });
}

/// Places are free and follow each other from column to column.
void ExpectPath(const FreeSpace& space, const GuidePath& path, const Eigen::Vector3d& from,
                const Eigen::Vector3d& to) {
  ASSERT_GE(path.size(), 2u);
  EXPECT_EQ(space.map->CellOf(path.front()), space.map->CellOf(from));
  EXPECT_EQ(space.map->CellOf(path.back()), space.map->CellOf(to));
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_FALSE(space.Blocked(path[i])) << path[i].transpose();
    if (i == 0) continue;
    const Eigen::Vector2d step = (path[i] - path[i - 1]).head<2>();
    EXPECT_LT(step.norm(), std::sqrt(2.0) * space.map->resolution() + 1e-9);
  }
}

// It finds a way wherever the exact search on the cells does, about as short.
TEST(SpanSearch, FindsAWayWhereThereIsOneAndHardlyLongerThanTheShortest) {
  Draw draw(41);
  SpanSearch search(kPlain);
  GridSearch exact(2.0);
  int found = 0, expansions = 0, of_cells = 0;
  for (int trial = 0; trial < 40; ++trial) {
    OccupancyMap map(SmallMap(0.2));
    const int boxes = trial < 30 ? 12 : 40;
    for (int i = 0; i < boxes; ++i) {
      const Eigen::Vector3d low{draw.Uniform(-2.2, 2.0), draw.Uniform(-2.8, 2.5),
                                draw.Uniform(-1.6, 1.0)};
      Fill(&map, low,
           low + Eigen::Vector3d{draw.Uniform(0.1, 0.7), draw.Uniform(0.1, 1.5),
                                 draw.Uniform(0.2, 2.5)});
    }
    const FreeSpace space = SpaceOf(map);
    const Eigen::Vector3d from{-2.95, draw.Uniform(-2.0, 2.0), draw.Uniform(-1.0, 1.0)};
    const Eigen::Vector3d to{2.95, draw.Uniform(-2.0, 2.0), draw.Uniform(-1.0, 1.0)};
    GuidePath path, shortest;
    const SearchStatus status = search.Search(space, from, to, kEnough, &path);
    ASSERT_EQ(status, exact.Search(space, from, to, kEnough, &shortest)) << "trial " << trial;
    if (status != SearchStatus::kFound) continue;
    ++found;
    expansions += search.expansions();
    of_cells += exact.expansions();
    EXPECT_LT(PathLength(path), 1.25 * PathLength(shortest) + 0.3) << "trial " << trial;
    CellIndex start = map.CellOf(from), goal = map.CellOf(to);
    GridSearch::NearestFree(space, &start);
    GridSearch::NearestFree(space, &goal);
    ExpectPath(space, path, map.CentreOf(start), map.CentreOf(goal));
  }
  EXPECT_GT(found, 25);
  EXPECT_LT(expansions, of_cells / 2);
}

TEST(SpanSearch, GoesAroundWhatIsNarrowAndOverWhatIsLow) {
  const Eigen::Vector3d from(-2.0, 0.05, 0.05), to(2.0, 0.05, 0.05);
  SpanSearch search(kPlain);
  GuidePath path;
  const auto farthest = [&](int axis, const OccupancyMap& map) {
    const FreeSpace space = SpaceOf(map);
    EXPECT_EQ(search.Search(space, from, to, kEnough, &path), SearchStatus::kFound);
    ExpectPath(space, path, from, to);
    double most = 0.0;
    for (const Eigen::Vector3d& p : path) most = std::max(most, std::abs(p[axis]));
    return most;
  };
  OccupancyMap pillar(SmallMap(0.0));
  Fill(&pillar, {0.0, -0.4, -1.6}, {0.2, 0.6, 1.6});
  EXPECT_LT(farthest(2, pillar), 0.1);
  EXPECT_GT(farthest(1, pillar), 0.4);
  OccupancyMap sill(SmallMap(0.0));
  Fill(&sill, {0.0, -3.2, -1.6}, {0.2, 3.2, 0.4});
  EXPECT_LT(farthest(1, sill), 0.2);
  EXPECT_GT(farthest(2, sill), 0.4);
  // The heights are as straight as possible: no step at the wall, and no higher than needed.
  EXPECT_LT(farthest(2, sill), 0.65);
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_LT(std::abs(path[i].z() - path[i - 1].z()), 0.05);
  }
}

TEST(SpanSearch, FindsTheOneWindowOfAWallSoonerThanCells) {
  OccupancyMap map(SmallMap(0.0));
  Fill(&map, {0.0, -3.2, -1.6}, {0.2, 3.2, 1.6});
  OccupancyMap open(SmallMap(0.0));
  Fill(&open, {0.0, -3.2, -1.6}, {0.2, 2.4, 1.6});
  Fill(&open, {0.0, 2.8, -1.6}, {0.2, 3.2, 1.6});
  Fill(&open, {0.0, 2.3, -1.6}, {0.2, 2.9, 0.8});
  Fill(&open, {0.0, 2.3, 1.2}, {0.2, 2.9, 1.6});
  const Eigen::Vector3d from(-2.0, -2.0, -1.05), to(2.0, -2.0, -1.05);
  SpanSearch search(kPlain, 1.5);
  GridSearch cells(2.0, 1.5);
  GuidePath path;
  const FreeSpace closed_space = SpaceOf(map), space = SpaceOf(open);
  EXPECT_EQ(search.Search(closed_space, from, to, kEnough, &path), SearchStatus::kNoPath);
  EXPECT_TRUE(path.empty());
  ASSERT_EQ(search.Search(space, from, to, kEnough, &path), SearchStatus::kFound);
  ExpectPath(space, path, from, to);
  ASSERT_EQ(cells.Search(space, from, to, kEnough, &path), SearchStatus::kFound);
  EXPECT_LT(search.expansions(), cells.expansions() / 8);
}

TEST(SpanSearch, WidePassagesArePreferredToTightOnes) {
  OccupancyMap map(SmallMap(0.0));
  // A gap of one cell ahead and one of a metre beside it.
  Fill(&map, {0.0, -3.2, -1.6}, {0.1, 0.0, 1.6});
  Fill(&map, {0.0, 0.1, -1.6}, {0.1, 0.6, 1.6});
  Fill(&map, {0.0, 1.6, -1.6}, {0.1, 3.2, 1.6});
  const FreeSpace space = SpaceOf(map);
  const auto crosses_at = [&](SpanSearch search) {
    GuidePath path;
    EXPECT_EQ(search.Search(space, {-1.55, 0.05, 0.05}, {1.55, 0.05, 0.05}, kEnough, &path),
              SearchStatus::kFound);
    for (const Eigen::Vector3d& p : path) {
      if (std::abs(p.x() - 0.05) < 0.05) return p.y();
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_NEAR(crosses_at(SpanSearch(kPlain)), 0.05, 1e-9);
  EXPECT_GT(crosses_at(SpanSearch({2.0, 8.0})), 0.6);
}

TEST(SpanSearch, NothingFitsBetweenTwoCornersThatTouch) {
  OccupancyMap map(SmallMap(0.0));
  Fill(&map, {0.0, -9.0, -9.0}, {0.1, 0.1, 9.0});
  const FreeSpace space = SpaceOf(map);
  SpanSearch search(kPlain);
  GuidePath path;
  const Eigen::Vector3d from(-1.05, 0.55, 0.05), to(1.05, -0.55, 0.05);
  EXPECT_EQ(search.Search(space, from, to, kEnough, &path), SearchStatus::kFound);
  Fill(&map, {0.1, 0.1, -9.0}, {0.2, 9.0, 9.0});
  EXPECT_EQ(search.Search(space, from, to, kEnough, &path), SearchStatus::kNoPath);
}

TEST(SpanSearch, LooksAtNoWayThatCostsMoreThanAllowed) {
  OccupancyMap map(SmallMap(0.0));
  Fill(&map, {0.0, -1.0, -1.6}, {0.2, 1.0, 1.6});
  const FreeSpace space = SpaceOf(map);
  const Eigen::Vector3d from(-1.0, 0.05, 0.05), to(1.0, 0.05, 0.05);
  SpanSearch search(kPlain);
  GuidePath path;
  ASSERT_EQ(search.Search(space, from, to, kEnough, &path), SearchStatus::kFound);
  const double cost = search.cost();
  EXPECT_GT(cost, 2.0);
  EXPECT_LT(cost, 4.0);
  EXPECT_EQ(search.Search(space, from, to, kEnough, &path, {}, 1.01 * cost), SearchStatus::kFound);
  EXPECT_EQ(search.Search(space, from, to, kEnough, &path, {}, 0.9 * cost), SearchStatus::kNoPath);
  const int bounded = search.expansions();
  Fill(&map, {0.0, -3.2, -1.6}, {0.2, 3.2, 1.6});
  EXPECT_EQ(search.Search(space, from, to, kEnough, &path), SearchStatus::kNoPath);
  EXPECT_LT(bounded, search.expansions() / 2);
}

TEST(SpanSearch, NamesWhatStopsIt) {
  OccupancyMap map(SmallMap(0.1));
  const FreeSpace space = SpaceOf(map);
  SpanSearch search(kPlain);
  GuidePath path;
  EXPECT_EQ(search.Search(space, {-1, 0, 0}, {1, 0, 0}, 3, &path), SearchStatus::kExpansionLimit);
  EXPECT_EQ(search.expansions(), 3);
  EXPECT_EQ(search.Search(space, {-1, 0, 0}, {100, 0, 0}, 1000, &path), SearchStatus::kEndsOutside);
  EXPECT_EQ(search.expansions(), 0);
  Fill(&map, {-3.2, -3.2, -1.6}, {3.2, 3.2, 1.6});
  EXPECT_EQ(search.Search(space, {-1, 0, 0}, {1, 0, 0}, 1000, &path), SearchStatus::kEndsBlocked);
}

// A wall ahead, open at one side: the way leaves the window there, not where the straight line would.
TEST(SpanSearch, AWayOutLeavesTheWindowWhereItCan) {
  OccupancyMap map(SmallMap(0.1));
  Fill(&map, {2.0, -3.2, -1.6}, {2.3, 2.0, 1.6});
  const FreeSpace space = SpaceOf(map);
  SpanSearch search(kPlain);
  GuidePath path;
  const Eigen::Vector3d from(0.05, 0.05, 0.05), goal(100.05, 0.05, 0.05);
  ASSERT_EQ(search.SearchOut(space, from, goal, kEnough, &path), SearchStatus::kFound);
  const bool around =
      std::any_of(path.begin(), path.end(), [](const Eigen::Vector3d& p) { return p.y() > 2.0; });
  EXPECT_TRUE(around);
  EXPECT_NEAR(path.back().x(), 3.15, 1e-9);
  EXPECT_GT(search.cost(), 100.0);
  EXPECT_LT(search.cost(), 103.0);
  Fill(&map, {2.0, 2.0, -1.6}, {2.3, 3.2, 1.6});
  ASSERT_EQ(search.SearchOut(space, from, goal, kEnough, &path), SearchStatus::kFound)
      << "through a side of the window";
  EXPECT_LT(path.back().x(), 2.0);
  const double here = search.cost();
  ASSERT_EQ(search.SearchOut(space, from, {1.05, 0.05, 0.05}, kEnough, &path),
            SearchStatus::kFound);
  EXPECT_NEAR(search.cost(), 1.0, 1e-3) << "as Search within the window";
  EXPECT_GT(here, 100.0);
}

// The goal is in the window, and only a way around it leads there.
TEST(SpanSearch, AGoalThatIsReachedFromOutsideOnly) {
  OccupancyMap map(SmallMap(0.1));
  Fill(&map, {1.0, -3.2, -1.6}, {1.3, 3.2, 1.6});
  const FreeSpace space = SpaceOf(map);
  SpanSearch search(kPlain);
  GuidePath path;
  const Eigen::Vector3d from(0.05, 0.05, 0.05), goal(2.05, 0.05, 0.05);
  ASSERT_EQ(search.SearchOut(space, from, goal, kEnough, &path), SearchStatus::kFound);
  EXPECT_EQ(search.end(), SpanSearch::End::kSide);
  EXPECT_LT(path.back().x(), 1.0);
  EXPECT_GT(search.cost(), 2.0);
  ASSERT_EQ(search.SearchOut(space, from, {0.55, 2.05, 0.05}, kEnough, &path),
            SearchStatus::kFound);
  EXPECT_EQ(search.end(), SpanSearch::End::kGoal);
}

// Walls all around, from the window's bottom to its top, or with one end closed.
TEST(SpanSearch, OutOfAShaftTheWayLeadsThroughItsOpenEnd) {
  for (const double open : {-1.6, 1.6}) {
    OccupancyMap map(SmallMap(0.0));
    const double low = open < 0.0 ? -1.6 : -1.0, high = open < 0.0 ? 1.0 : 1.6;
    for (const double side : {-1.0, 0.9}) {
      Fill(&map, {side, -1.0, low}, {side + 0.1, 1.0, high});
      Fill(&map, {-1.0, side, low}, {1.0, side + 0.1, high});
    }
    const double end = open < 0.0 ? high - 0.1 : low;
    Fill(&map, {-1.0, -1.0, end}, {1.0, 1.0, end + 0.1});
    const FreeSpace space = SpaceOf(map);
    SpanSearch search(kPlain);
    GuidePath path;
    const Eigen::Vector3d from(0.05, 0.05, 0.05), goal(2.05, 0.05, 0.05);
    ASSERT_EQ(search.SearchOut(space, from, goal, kEnough, &path), SearchStatus::kFound) << open;
    EXPECT_EQ(search.end(), SpanSearch::End::kAnywhere);
    EXPECT_NEAR(path.back().z(), open < 0.0 ? -1.55 : 1.55, 1e-9);
    EXPECT_NEAR(search.cost(), 2.0 + 2.0 * 2.0 * 1.55, 0.3);
    EXPECT_EQ(search.Escape(space, from, kEnough), SearchStatus::kFound);
  }
}

// The start is in the zone of a wall, and with the goal in a closed room.
TEST(SpanSearch, AStartBesideAWallIsInTheRoomOfItsGoal) {
  OccupancyMap map(SmallMap(0.3));
  for (const double side : {-1.5, 1.4}) {
    Fill(&map, {side, -1.5, -1.6}, {side + 0.1, 1.5, 1.6});
    Fill(&map, {-1.5, side, -1.6}, {1.5, side + 0.1, 1.6});
  }
  FreeSpace space = SpaceOf(map);
  space.floor = -1.0;
  space.ceiling = 1.0;
  SpanSearch search(kPlain);
  GuidePath path;
  const Eigen::Vector3d from(-1.25, 0.05, 0.05), goal(0.55, 0.05, 0.05);
  ASSERT_TRUE(space.Blocked(from));
  EXPECT_EQ(search.SearchOut(space, from, goal, kEnough, &path), SearchStatus::kFound);
  EXPECT_EQ(search.end(), SpanSearch::End::kGoal);
}

TEST(SpanSearch, NothingEscapesFromAClosedBoxButAnyHoleWillDo) {
  const Eigen::Vector3d inside(0.05, 0.05, 0.05);
  SpanSearch search(kPlain);
  const auto escape = [&](const auto& open) {
    OccupancyMap map(SmallMap(0.0));
    for (int i = -10; i <= 10; ++i) {
      for (int j = -10; j <= 10; ++j) {
        for (const int side : {-10, 10}) {
          for (int axis = 0; axis < 3; ++axis) {
            CellIndex cell;
            cell[axis] = side;
            cell[(axis + 1) % 3] = i;
            cell[(axis + 2) % 3] = j;
            map.SetOccupied(map.CentreOf(cell));
          }
        }
      }
    }
    open(&map);
    return search.Escape(SpaceOf(map), inside, kEnough);
  };
  EXPECT_EQ(escape([](OccupancyMap*) {}), SearchStatus::kNoPath);
  const auto hole = [](const CellIndex& cell) {
    return [cell](OccupancyMap* map) { map->SetState(cell, CellState::kFree); };
  };
  for (const CellIndex& cell : {CellIndex(10, 3, 2), {-4, -10, 0}, {1, 2, 10}, {-3, 0, -10}}) {
    EXPECT_EQ(escape(hole(cell)), SearchStatus::kFound) << cell.transpose();
  }
}

TEST(SpanSearch, AWayDownOutOfTheWindowEndsAtItsLowestCells) {
  OccupancyMap map(SmallMap(0.1));
  const FreeSpace space = SpaceOf(map);
  SpanSearch search(kPlain);
  GuidePath path;
  ASSERT_EQ(search.SearchOut(space, {0.05, 0.05, 0.05}, {1.05, 0.05, -4.95}, kEnough, &path),
            SearchStatus::kFound);
  EXPECT_NEAR(search.cost(), 1.0 + 2.0 * 5.0, 1e-3);
  EXPECT_NEAR(path.back().z(), -1.55, 1e-9);
}

TEST(SpanSearch, ABlockedEndIsMovedAndOneColumnIsAWay) {
  OccupancyMap map(SmallMap(0.0));
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  SpanSearch search(kPlain);
  GuidePath path;
  ASSERT_EQ(search.Search(space, {0.05, 0.05, 0.05}, {1.05, 0.05, 0.05}, kEnough, &path),
            SearchStatus::kFound);
  EXPECT_NEAR((path.front() - Eigen::Vector3d(0.05, 0.05, 0.05)).norm(), 0.1, 1e-9);
  ASSERT_EQ(search.Search(space, {1.05, 0.05, -0.45}, {1.05, 0.05, 0.55}, kEnough, &path),
            SearchStatus::kFound);
  EXPECT_NEAR(PathLength(path), 1.0, 1e-9);
}

TEST(SpanSearch, ABarrierLeadsTheOtherWay) {
  OccupancyMap map(SmallMap(0.0));
  Fill(&map, {0.0, -0.4, -1.6}, {0.2, 0.6, 1.6});
  const FreeSpace space = SpaceOf(map);
  const Eigen::Vector3d from(-1.0, 0.05, 0.05), to(1.0, 0.05, 0.05);
  SpanSearch search(kPlain);
  GuidePath path;
  ASSERT_EQ(search.Search(space, from, to, kEnough, &path), SearchStatus::kFound);
  FlatState through;
  through.p_WB = {0.05, 0.05, 0.05};
  through.v_WB = Eigen::Vector3d::UnitX();
  const std::optional<Barrier> barrier = ClosePath(path, through);
  ASSERT_TRUE(barrier);
  const double side = barrier->side.y();
  ASSERT_EQ(search.Search(space, from, to, kEnough, &path, std::span(&*barrier, 1)),
            SearchStatus::kFound);
  const std::optional<Barrier> other = ClosePath(path, through);
  ASSERT_TRUE(other);
  EXPECT_LT(other->side.y() * side, 0.0);
}

TEST(SpanSearch, FindsTheSameWayAgainAfterAMoveAndOnASmallerWindow) {
  OccupancyMap map(SmallMap(0.0));
  Fill(&map, {0.0, 0.0, -1.6}, {0.1, 0.1, 1.6});
  const FreeSpace space = SpaceOf(map);
  OccupancyMapOptions small = SmallMap(0.0);
  small.size_log2 = {5, 5, 4};
  const OccupancyMap empty(small);
  const FreeSpace empty_space = SpaceOf(empty);
  SpanSearch search(kPlain);
  GuidePath first, again, other;
  const auto find = [&](SpanSearch* by, GuidePath* path) {
    return by->Search(space, {-1.05, 0.05, 0.05}, {1.05, 0.05, 0.05}, kEnough, path);
  };
  ASSERT_EQ(find(&search, &first), SearchStatus::kFound);
  ASSERT_EQ(search.Search(empty_space, {-1, 0, 0}, {1, 0, 0}, kEnough, &other),
            SearchStatus::kFound);
  SpanSearch moved = std::move(search);
  ASSERT_EQ(find(&moved, &again), SearchStatus::kFound);
  EXPECT_EQ(again, first);
}

TEST(SpanSearch, RefusesFactorsOutOfRange) {
  EXPECT_THROW(SpanSearch({0.9, 1.0}), std::invalid_argument);
  EXPECT_THROW(SpanSearch({2.0, 0.9}), std::invalid_argument);
  EXPECT_THROW(SpanSearch({2.0, 1.0}, 0.9), std::invalid_argument);
  const double none = std::numeric_limits<double>::infinity();
  EXPECT_THROW(SpanSearch({none, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
