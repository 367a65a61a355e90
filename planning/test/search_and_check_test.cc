// SPDX-License-Identifier: BSD-3-Clause
// Voxel traversal, the whole-curve check, A*, pairs and the certificate, on random maps and against
// independent computations.

#include <gtest/gtest.h>

#include <queue>
#include <set>

#include "touchdown/planning/certificate.h"
#include "touchdown/planning/collision_pairs.h"
#include "touchdown/planning/curve_check.h"
#include "touchdown/planning/grid_search.h"
#include "touchdown/planning/test/planning_fixtures.h"
#include "touchdown/planning/voxel_traversal.h"

namespace touchdown::planning {
namespace {

OccupancyMapOptions SmallMap(double inflation) {
  OccupancyMapOptions options;
  options.size_log2 = {6, 6, 5};
  options.inflation_radius = inflation;
  return options;
}

FreeSpace SpaceOf(const OccupancyMap& map) {
  FreeSpace space;
  space.map = &map;
  space.floor = -100.0;
  return space;
}

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

/// Random single cells and pillars.
void Scatter(Draw* draw, int pillars, OccupancyMap* map) {
  for (int i = 0; i < pillars; ++i) {
    const double x = draw->Uniform(-2.5, 2.5), y = draw->Uniform(-2.5, 2.5);
    for (double z = -1.5; z < 1.6; z += 0.1) map->SetOccupied({x, y, z});
  }
}

TEST(CurveCheck, AgreesWithDenseSampling) {
  Draw draw(22);
  int blocked_curves = 0;
  for (int trial = 0; trial < 100; ++trial) {
    OccupancyMap map(SmallMap(0.2));
    Scatter(&draw, 6, &map);
    ControlPoints q(3, 10);
    for (int i = 0; i < 10; ++i) {
      q.col(i) = Eigen::Vector3d(-2.5 + 0.55 * i, 0.0, 0.0) + draw.Vector(0.7);
    }
    const UniformBspline curve(q, 0.3, 2.0);
    const FreeSpace space = SpaceOf(map);
    std::vector<BlockedRun> runs;
    FindBlockedRuns(curve, 2.0, space, &runs);
    blocked_curves += !runs.empty();
    EXPECT_EQ(runs.empty(), std::isinf(FirstBlockedTime(curve, 2.0, space)));
    for (double t = 2.0; t <= curve.t_end(); t += 0.0005) {
      if (!space.Blocked(curve.Evaluate(t).p_WB)) continue;
      const bool covered = std::any_of(runs.begin(), runs.end(), [&](const BlockedRun& run) {
        return t >= run.t_in && t <= run.t_out;
      });
      // Chords leave the curve by up to 2 mm, so a cell clipped by less may be missed on it.
      const Eigen::Vector3d p = curve.Evaluate(t).p_WB;
      bool deep = true;
      for (int c = 0; c < 6; ++c) {
        Eigen::Vector3d near = p;
        near[c / 2] += c % 2 ? 0.003 : -0.003;
        deep = deep && space.Blocked(near);
      }
      EXPECT_TRUE(covered || !deep) << "trial " << trial << " t " << t;
    }
  }
  EXPECT_GT(blocked_curves, 20);
}

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

TEST(CollisionPairs, PointOutOfTheObstacleTowardsTheGuide) {
  OccupancyMap map(SmallMap(0.3));
  for (double z = -1.5; z < 1.6; z += 0.1) map.SetOccupied({0.05, 0.05, z});
  const FreeSpace space = SpaceOf(map);
  ControlPoints q(3, 14);
  for (int i = 0; i < 14; ++i) q.col(i) = Eigen::Vector3d(-2.4 + 0.37 * i, 0.02, 0.05);
  const UniformBspline curve(q, 0.2, 0.0);
  std::vector<BlockedRun> runs;
  FindBlockedRuns(curve, 0.0, space, &runs);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_FALSE(runs[0].at_start);
  EXPECT_FALSE(runs[0].at_end);
  GuidePath guide = {{-1.0, 0.0, 0.05}, {0.0, 1.0, 0.05}, {1.0, 0.0, 0.05}};
  std::vector<ObstaclePair> pairs;
  EXPECT_GT(BindPairs(curve, runs[0], guide, space, 50, &pairs), 0);
  for (const ObstaclePair& pair : pairs) {
    EXPECT_GT(pair.v.y(), 0.9);                 // the guide passes on the left
    EXPECT_FALSE(space.Blocked(pair.p));        // p is the last free point ...
    EXPECT_TRUE(space.Blocked(Eigen::Vector3d(pair.p - 0.15 * pair.v)));  // ... before the obstacle
  }
}

TEST(Certificate, ProvesOrNamesEachPart) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkOwnVolume(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}, end{{2, 0, 0}, {0.5, 0, 0}, {0, 0, 0}};
  const UniformBspline curve(HermiteControlPoints(start, end, 12, 4.0), 4.0 / 12, 0.0);
  EXPECT_TRUE(Certify(curve, 0.0, &end, {3.0, 6.0}, 0.1, space).passed());
  EXPECT_FALSE(Certify(curve, 0.0, &end, {1.0, 6.0}, 0.1, space).limits_kept);
  EXPECT_FALSE(Certify(curve, 0.0, &end, {3.0, 0.5}, 0.1, space).limits_kept);
  SplineState elsewhere = end;
  elsewhere.p.x() += 1e-6;
  EXPECT_FALSE(Certify(curve, 0.0, &elsewhere, {3.0, 6.0}, 0.1, space).passed());
  map.SetOccupied({0.0, 0.0, 0.0});
  const Certificate hit = Certify(curve, 0.0, &end, {3.0, 6.0}, 0.1, space);
  EXPECT_FALSE(hit.clear);
  EXPECT_NEAR(curve.Evaluate(hit.first_hit_t).p_WB.x(), -0.35, 0.1);
  EXPECT_TRUE(Certify(curve, 3.0, &end, {3.0, 6.0}, 0.1, space).passed());  // already past it
}

TEST(Certificate, AStartBeyondALimitIsHeldToItsRecovery) {
  OccupancyMap map(SmallMap(0.2));
  map.MarkOwnVolume(Eigen::Vector3d::Zero(), 5.0);
  const FreeSpace space = SpaceOf(map);
  const SplineState fast{{-2, 0, 0}, {3.5, 0, 0}, {0, 0, 0}};
  const SplineState slow{{1.0, 0, 0}, {0.5, 0, 0}, {0, 0, 0}};
  const UniformBspline recovers(HermiteControlPoints(fast, slow, 12, 1.5), 1.5 / 12, 0.0);
  const Certificate yes = Certify(recovers, 0.0, &slow, {3.0, 6.0}, 0.1, space);
  EXPECT_TRUE(yes.recovering);
  EXPECT_TRUE(yes.limits_kept);
  const SplineState faster{{2.0, 0, 0}, {3.5, 0, 0}, {0, 0, 0}};
  const UniformBspline persists(HermiteControlPoints(fast, faster, 12, 1.2), 0.1, 0.0);
  EXPECT_FALSE(Certify(persists, 0.0, &faster, {3.0, 6.0}, 0.1, space).limits_kept);
}

TEST(Certificate, AStartInTheInflatedZoneMayOnlyLeave) {
  OccupancyMap map(SmallMap(0.4));
  map.MarkOwnVolume(Eigen::Vector3d::Zero(), 5.0);
  map.SetOccupied({0.05, 0.05, 0.05});
  const FreeSpace space = SpaceOf(map);
  const SplineState inside{{0.35, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const SplineState out{{1.5, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const SplineState through{{-1.5, 0.05, 0.05}, {0, 0, 0}, {0, 0, 0}};
  const UniformBspline leaves(HermiteControlPoints(inside, out, 12, 2.0), 2.0 / 12, 0.0);
  const UniformBspline crosses(HermiteControlPoints(inside, through, 12, 2.0), 2.0 / 12, 0.0);
  const Certificate yes = Certify(leaves, 0.0, &out, {3.0, 6.0}, 0.1, space);
  EXPECT_TRUE(yes.escaping);
  EXPECT_TRUE(yes.passed());
  EXPECT_LT(yes.clearance, 0.4);
  EXPECT_FALSE(Certify(crosses, 0.0, &through, {3.0, 6.0}, 0.1, space).passed());
}

TEST(Certificate, NeedsRoomToBrakeInObservedSpace) {
  OccupancyMap map(SmallMap(0.2));
  const FreeSpace space = SpaceOf(map);
  const SplineState start{{-2, 0, 0}, {2, 0, 0}, {0, 0, 0}}, end{{2, 0, 0}, {2, 0, 0}, {0, 0, 0}};
  const UniformBspline curve(HermiteControlPoints(start, end, 12, 2.0), 2.0 / 12, 0.0);
  EXPECT_FALSE(Certify(curve, 0.0, &end, {3.0, 6.0}, 0.1, space).passed());
  // 2 m/s take 4 / (2 * 0.6 * 6) = 0.56 m, from where the vehicle is after 0.1 s.
  map.MarkOwnVolume({-2, 0, 0}, 0.6);
  EXPECT_FALSE(Certify(curve, 0.0, &end, {3.0, 6.0}, 0.1, space).stops_in_observed_space);
  map.MarkOwnVolume({-2, 0, 0}, 0.9);
  EXPECT_TRUE(Certify(curve, 0.0, &end, {3.0, 6.0}, 0.1, space).passed());
}

}  // namespace
}  // namespace touchdown::planning
