// SPDX-License-Identifier: BSD-3-Clause
// A* against Dijkstra, and the limits that stop it.

#include "planning/search/grid_search.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <queue>

#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

constexpr double kUp = 2.0;

/// Length of the shortest path by Dijkstra on the same lattice, independent of A*'s heuristic.
double DijkstraLength(const FreeSpace& space, const CellIndex& from, const CellIndex& to) {
  std::map<std::array<int, 3>, double> best;
  using Item = std::pair<double, std::array<int, 3>>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  queue.push({0.0, {from.x(), from.y(), from.z()}});
  while (!queue.empty()) {
    const auto [length, at] = queue.top();
    queue.pop();
    if (best.count(at)) continue;
    best[at] = length;
    if (at == std::array<int, 3>{to.x(), to.y(), to.z()}) return length;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const CellIndex next(at[0] + dx, at[1] + dy, at[2] + dz);
          if (!space.map->InWindow(next) || space.Blocked(next)) continue;
          queue.push({length + std::sqrt(dx * dx + dy * dy + kUp * kUp * dz * dz),
                      {next.x(), next.y(), next.z()}});
        }
      }
    }
  }
  return std::numeric_limits<double>::infinity();
}

// Rows of bits must give the same as a test of every cell. This includes the window's edges,
// levels, and rows within reach that are longer than a word.
TEST(GridSearch, TheNearestFreeCellIsThatOfALookAtEveryCell) {
  Draw draw(5);
  int moved = 0, lost = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const bool fine = trial % 6 == 5;
    OccupancyMapOptions options = SmallMap(fine ? 0.12 : 0.3);
    options.resolution = fine ? 0.04 : 0.1;
    options.size_log2 = {fine ? 7 : 5, fine ? 6 : 5, 4};
    OccupancyMap map(options);
    const Eigen::Vector3d half = 0.5 * options.resolution * map.size().cast<double>();
    const auto somewhere = [&](double share) {
      return Eigen::Vector3d{draw.Uniform(-1.0, 1.0) * share * half.x(),
                             draw.Uniform(-1.0, 1.0) * share * half.y(),
                             draw.Uniform(-1.0, 1.0) * share * half.z()};
    };
    const int obstacles = fine ? 3000 : trial % 3 == 0 ? 400 : 40;
    for (int i = 0; i < obstacles; ++i) map.SetOccupied(somewhere(1.0));
    FreeSpace space = SpaceOf(map);
    space.ceiling = draw.Uniform(0.25, 1.1) * half.z();
    space.floor = -draw.Uniform(0.1, 1.1) * half.z();
    space.pad_radius = 0.5;
    space.pad_floor = -1.1 * half.z();
    const CellIndex at = map.CellOf(somewhere(0.95));
    const double reach = GridSearch::kEndSearchRadius / map.resolution();
    const int cells = static_cast<int>(reach);
    // Squared distance, half side of the cube, and the place in it: the least is wanted.
    std::array<int, 5> least = {static_cast<int>(reach * reach), 0, 0, 0, 0};
    bool any = !space.Blocked(at);
    CellIndex wanted = at;
    for (int z = -cells; !any && z <= cells; ++z) {
      for (int y = -cells; y <= cells; ++y) {
        for (int x = -cells; x <= cells; ++x) {
          const CellIndex cell = at + CellIndex(x, y, z);
          const std::array<int, 5> rank = {
              x * x + y * y + z * z, std::max({std::abs(x), std::abs(y), std::abs(z)}), z, y, x};
          if (rank >= least || !map.InWindow(cell) || space.Blocked(cell)) continue;
          least = rank;
          wanted = cell;
        }
      }
    }
    any = any || wanted != at;
    CellIndex found = at;
    ASSERT_EQ(GridSearch::NearestFree(space, &found), any) << "trial " << trial;
    EXPECT_EQ(found, wanted) << "trial " << trial;
    moved += wanted != at;
    lost += !any;
  }
  EXPECT_GT(moved, 20);
  EXPECT_LT(lost, 20);
}

TEST(GridSearch, FindsShortestPathsThroughFreeCells) {
  Draw draw(23);
  OccupancyMapOptions options = SmallMap(0.2);
  options.size_log2 = {5, 5, 4};
  GridSearch search(kUp);
  for (int trial = 0; trial < 8; ++trial) {
    OccupancyMap map(options);
    for (int i = 0; i < 6; ++i) {
      const double x = draw.Uniform(-1.0, 1.0), y = draw.Uniform(-1.4, 1.4);
      for (double z = -0.75; z < 0.8; z += 0.1) map.SetOccupied({x, y, z});
    }
    const FreeSpace space = SpaceOf(map);
    const Eigen::Vector3d from(-1.45, -1.45, 0.05), to(1.45, 1.35, 0.05);
    GuidePath path;
    const SearchStatus status = search.Search(space, from, to, 100000, &path);
    const double shortest = DijkstraLength(space, map.CellOf(from), map.CellOf(to));
    ASSERT_EQ(status == SearchStatus::kFound, std::isfinite(shortest));
    if (status != SearchStatus::kFound) continue;
    double length = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      EXPECT_FALSE(space.Blocked(path[i]));
      if (i == 0) continue;
      const Eigen::Vector3d step = (path[i] - path[i - 1]) / map.resolution();
      length += Eigen::Vector3d(step.x(), step.y(), kUp * step.z()).norm();
    }
    EXPECT_NEAR(length, shortest, 1e-3);
  }
}

TEST(GridSearch, NamesWhatStopsIt) {
  OccupancyMap map(SmallMap(0.0));
  const FreeSpace space = SpaceOf(map);
  GridSearch search;
  GuidePath path;
  EXPECT_EQ(search.Search(space, {0, 0, 0}, {50, 0, 0}, 1000, &path), SearchStatus::kEndsOutside);
  EXPECT_EQ(search.Search(space, {-3, -3, 0}, {3, 3, 0}, 5, &path), SearchStatus::kExpansionLimit);
  // A closed shell around the goal.
  for (double x = -0.95; x < 1.0; x += 0.1) {
    for (double y = -0.95; y < 1.0; y += 0.1) {
      for (double z = -0.95; z < 1.0; z += 0.1) {
        const double far = std::max({std::abs(x), std::abs(y), std::abs(z)});
        if (far > 0.9) map.SetOccupied({x, y, z});
      }
    }
  }
  EXPECT_EQ(search.Search(space, {-3, -3, 0.05}, {0.05, 0.05, 0.05}, 200000, &path),
            SearchStatus::kNoPath);
  // The search is the caller's object: it works again after any failure.
  EXPECT_EQ(search.Search(space, {-3, -3, 0.05}, {-3, 3, 0.05}, 200000, &path),
            SearchStatus::kFound);
}

TEST(GridSearch, MovesBlockedEndsToFreeCells) {
  OccupancyMap map(SmallMap(0.3));
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  GridSearch search;
  GuidePath path;
  ASSERT_EQ(search.Search(space, {0.05, 0.05, 0.05}, {2.0, 0.0, 0.0}, 10000, &path),
            SearchStatus::kFound);
  EXPECT_FALSE(space.Blocked(path.front()));
}

double CostOf(const GuidePath& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector3d step = path[i] - path[i - 1];
    sum += Eigen::Vector3d(step.x(), step.y(), kUp * step.z()).norm();
  }
  return sum;
}

TEST(GridSearch, GreedFindsAPathSoonerAndAtMostSoManyTimesAsLong) {
  Draw draw(5);
  constexpr double kGreed = 3.0;
  GridSearch exact(kUp), greedy(kUp, kGreed);
  int found = 0, expansions = 0, expansions_greedy = 0;
  for (int trial = 0; trial < 40; ++trial) {
    OccupancyMap map(SmallMap(0.1));
    for (int i = 0; i < 60; ++i) {
      map.SetOccupied({draw.Uniform(-1.5, 1.5), draw.Uniform(-2.5, 2.5), draw.Uniform(-1.5, 1.5)});
    }
    const FreeSpace space = SpaceOf(map);
    const Eigen::Vector3d from(-2.0, draw.Uniform(-1, 1), 0.0), to(2.0, draw.Uniform(-1, 1), 0.0);
    GuidePath shortest, path;
    if (exact.Search(space, from, to, 100000, &shortest) != SearchStatus::kFound) continue;
    ASSERT_EQ(greedy.Search(space, from, to, 100000, &path), SearchStatus::kFound);
    for (const Eigen::Vector3d& p : path) EXPECT_FALSE(space.Blocked(p));
    EXPECT_LE(CostOf(path), kGreed * CostOf(shortest) + 1e-4);
    expansions += exact.expansions();
    expansions_greedy += greedy.expansions();
    ++found;
  }
  EXPECT_GT(found, 30);
  EXPECT_LT(expansions_greedy, expansions / 2);
}

TEST(GridSearch, WidePassagesArePreferredToTightOnes) {
  OccupancyMap map(SmallMap(0.0));
  // A wall across x = 0 with a gap of one cell ahead and one of a metre beside it.
  for (double y = -3.15; y < 3.2; y += 0.1) {
    if (std::abs(y - 0.05) < 0.01 || (y > 0.6 && y < 1.6)) continue;
    for (double z = -1.55; z < 1.6; z += 0.1) map.SetOccupied({0.05, y, z});
  }
  const FreeSpace space = SpaceOf(map);
  const Eigen::Vector3d from(-1.55, 0.05, 0.05), to(1.55, 0.05, 0.05);
  const auto crosses_at = [&](GridSearch search) {
    GuidePath path;
    EXPECT_EQ(search.Search(space, from, to, 100000, &path), SearchStatus::kFound);
    for (const Eigen::Vector3d& p : path) {
      if (std::abs(p.x() - 0.05) < 0.05) return p.y();
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_NEAR(crosses_at(GridSearch(kUp)), 0.05, 1e-9);
  EXPECT_GT(crosses_at(GridSearch(kUp, 1.0, 8.0)), 0.6);
}

TEST(GridSearch, ASearchThatCannotBeginExpandsNothing) {
  OccupancyMap map(SmallMap(0.1));
  const FreeSpace space = SpaceOf(map);
  GridSearch search(kUp);
  GuidePath path;
  ASSERT_EQ(search.Search(space, {-1, 0, 0}, {1, 0, 0}, 1000, &path), SearchStatus::kFound);
  EXPECT_GT(search.expansions(), 0);
  EXPECT_EQ(search.Search(space, {-1, 0, 0}, {100, 0, 0}, 1000, &path), SearchStatus::kEndsOutside);
  EXPECT_EQ(search.expansions(), 0);
}

TEST(GridSearch, FindsTheSamePathAgainAndAfterAMove) {
  OccupancyMap map(SmallMap(0.0));
  for (double z = -1.55; z < 1.6; z += 0.1) map.SetOccupied({0.05, 0.05, z});
  const FreeSpace space = SpaceOf(map);
  GridSearch search(kUp);
  GuidePath first, again, moved;
  const auto find = [&](GridSearch* by, GuidePath* path) {
    return by->Search(space, {-1.05, 0.05, 0.05}, {1.05, 0.05, 0.05}, 100000, path);
  };
  ASSERT_EQ(find(&search, &first), SearchStatus::kFound);
  ASSERT_EQ(find(&search, &again), SearchStatus::kFound);
  GridSearch other = std::move(search);
  ASSERT_EQ(find(&other, &moved), SearchStatus::kFound);
  EXPECT_EQ(again, first);
  EXPECT_EQ(moved, first);
}

TEST(GridSearch, RefusesFactorsBelowOne) {
  EXPECT_THROW(GridSearch(0.9), std::invalid_argument);
  EXPECT_THROW(GridSearch(1.0, 0.9), std::invalid_argument);
  EXPECT_THROW(GridSearch(1.0, 1.0, 0.9), std::invalid_argument);
}

TEST(GridSearch, ABarrierLeadsTheOtherWay) {
  OccupancyMap map(SmallMap(0.1));
  for (double y = -0.45; y <= 0.5; y += 0.1) {
    for (double z = -0.8; z < 1.0; z += 0.1) map.SetOccupied({0.05, y, z});
  }
  FreeSpace space;
  space.map = &map;
  space.floor = -10.0;
  GridSearch search(kUp);
  const Eigen::Vector3d from(-1.05, 0.05, 0.05), to(1.05, 0.05, 0.05);
  std::vector<Eigen::Vector3d> path;
  std::vector<Barrier> barriers;
  std::vector<double> sides;
  for (int way = 0; way < 2; ++way) {
    ASSERT_EQ(search.Search(space, from, to, 100000, &path, barriers), SearchStatus::kFound);
    for (const Eigen::Vector3d& p : path) {
      EXPECT_FALSE(space.Blocked(p));
      if (std::abs(p.x() - 0.05) < 0.05) sides.push_back(p.y());
    }
    ASSERT_FALSE(sides.empty());
    barriers.push_back({Eigen::Vector3d(0.05, 0.05, 0.05), Eigen::Vector3d::UnitX(),
                        Eigen::Vector3d(0.0, sides.back() > 0.05 ? 1.0 : -1.0, 0.0)});
  }
  EXPECT_LT((sides.front() - 0.05) * (sides.back() - 0.05), 0.0);
}

}  // namespace
}  // namespace touchdown::planning
