// SPDX-License-Identifier: BSD-3-Clause
// The rolling map: fusion of synthetic depth frames, inflation against brute force, rolling.

#include "touchdown/planning/map/occupancy_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "planning/map/voxel_traversal.h"
#include "planning/test/planning_fixtures.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

OccupancyMapOptions SmallMap() {
  OccupancyMapOptions options;
  options.size_log2 = {6, 6, 4};
  options.inflation_radius = 0.3;
  return options;
}

/// A wall across the x axis at distance `wall`, seen by a camera that looks along +x.
estimation::DepthFrame WallFrame(const Eigen::Vector3d& p_WC, double wall) {
  estimation::DepthFrame frame;
  frame.p_WC = p_WC;
  frame.R_WC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  frame.max_range = 4.0;
  frame.depth.assign(80 * 60, std::numeric_limits<float>::infinity());
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Eigen::Vector3d ray((u + 0.5 - k.cx) / k.focal, (v + 0.5 - k.cy) / k.focal, 1.0);
      const double depth = wall - p_WC.x();
      if (depth * ray.norm() < frame.max_range) {
        frame.depth[static_cast<std::size_t>(v * k.width + u)] = static_cast<float>(depth);
      }
    }
  }
  return frame;
}

/// The inflation recomputed from the occupied cells alone.
void ExpectInflationIsConsistent(const OccupancyMap& map) {
  std::vector<CellIndex> occupied;
  CellIndex c;
  const CellIndex lo = map.origin(), hi = map.origin() + map.size();
  for (c.z() = lo.z(); c.z() < hi.z(); ++c.z()) {
    for (c.y() = lo.y(); c.y() < hi.y(); ++c.y()) {
      for (c.x() = lo.x(); c.x() < hi.x(); ++c.x()) {
        if (map.IsOccupied(c)) occupied.push_back(c);
      }
    }
  }
  const double reach = (map.options().inflation_radius + 0.002) / map.resolution();
  const bool inflated = map.options().inflation_radius > 0.0;
  int wrong = 0;
  for (c.z() = lo.z(); c.z() < hi.z(); ++c.z()) {
    for (c.y() = lo.y(); c.y() < hi.y(); ++c.y()) {
      for (c.x() = lo.x(); c.x() < hi.x(); ++c.x()) {
        bool blocked = false;
        for (const CellIndex& o : occupied) {
          const Eigen::Vector3d gap =
              ((c - o).cwiseAbs().array() - 1).max(0).matrix().cast<double>();
          blocked = blocked || c == o || (inflated && gap.norm() < reach);
        }
        wrong += blocked != map.IsBlocked(c);
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(OccupancyMap, SeesAWallAndWhatIsFreeBeforeIt) {
  OccupancyMap map(SmallMap());
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  const CellIndex wall = map.CellOf({2.01, 0.05, 0.85}), before = map.CellOf({1.5, 0.05, 0.85}),
                  behind = map.CellOf({2.6, 0.05, 0.85});
  EXPECT_FALSE(map.IsKnown(wall));
  EXPECT_FALSE(map.IsBlocked(wall));  // unknown is free
  map.Integrate(WallFrame(p_WC, 2.0), {});
  map.Integrate(WallFrame(p_WC, 2.0), {});
  EXPECT_TRUE(map.IsOccupied(wall));
  EXPECT_TRUE(map.IsKnown(before));
  EXPECT_FALSE(map.IsOccupied(before));
  EXPECT_FALSE(map.IsKnown(behind));
  EXPECT_TRUE(map.IsBlocked(map.CellOf({1.75, 0.05, 0.85})));  // inflated
  EXPECT_FALSE(map.IsBlocked(before));
  ExpectInflationIsConsistent(map);
}

TEST(OccupancyMap, OneHitBlocksHoweverOftenACellWasSeenFree) {
  OccupancyMap map(SmallMap());
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  const CellIndex cell = map.CellOf({2.01, 0.05, 0.85});
  for (int i = 0; i < 10; ++i) map.Integrate(WallFrame(p_WC, 3.0), {});
  EXPECT_TRUE(map.IsObservedFree(cell));
  map.Integrate(WallFrame(p_WC, 2.0), {});
  EXPECT_TRUE(map.IsOccupied(cell));
  EXPECT_FALSE(map.IsObservedFree(cell));
  EXPECT_TRUE(map.IsObservedFree(map.CellOf({1.5, 0.05, 0.85})));
  ExpectInflationIsConsistent(map);
}

TEST(OccupancyMap, AHitIsOutweighedFromNearerOnly) {
  OccupancyMap map(SmallMap());
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85), nearer(0.65, 0.05, 0.85);
  map.Recentre(p_WC);
  const CellIndex cell = map.CellOf({2.41, 0.05, 0.85});
  for (int i = 0; i < 2; ++i) map.Integrate(WallFrame(p_WC, 2.41), {});
  for (int i = 0; i < 20; ++i) map.Integrate(WallFrame(p_WC, 3.0), {});
  EXPECT_TRUE(map.IsOccupied(cell));
  // As many misses as there were hits make it unsure, one more free.
  for (int i = 0; i < 2; ++i) map.Integrate(WallFrame(nearer, 3.0), {});
  EXPECT_FALSE(map.IsOccupied(cell));
  EXPECT_FALSE(map.IsObservedFree(cell));
  map.Integrate(WallFrame(nearer, 3.0), {});
  EXPECT_TRUE(map.IsObservedFree(cell));
  EXPECT_TRUE(map.IsOccupied(map.CellOf({3.01, 0.05, 0.85})));
  ExpectInflationIsConsistent(map);
}

TEST(OccupancyMap, NothingIsFreedFartherThanAThinObstacleIsSeen) {
  OccupancyMapOptions options = SmallMap();
  options.thinnest_obstacle = 0.05;  // at a focal length of 40 pixels: 2 m
  OccupancyMap map(options);
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  map.Integrate(WallFrame(p_WC, 2.85), {});
  EXPECT_TRUE(map.IsObservedFree(map.CellOf({1.95, 0.05, 0.85})));
  EXPECT_FALSE(map.IsKnown(map.CellOf({2.15, 0.05, 0.85})));
  EXPECT_TRUE(map.IsOccupied(map.CellOf({2.86, 0.05, 0.85})));  // but what returned is there
}

TEST(OccupancyMap, NothingIsFreedWithinTheNoiseOfAReturn) {
  OccupancyMapOptions options = SmallMap();
  options.range_noise = 0.05;
  OccupancyMap map(options);
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  map.Integrate(WallFrame(p_WC, 2.05), {});
  // 3 sigma of 2 m are 0.3 m.
  EXPECT_TRUE(map.IsObservedFree(map.CellOf({1.65, 0.05, 0.85})));
  EXPECT_FALSE(map.IsKnown(map.CellOf({1.85, 0.05, 0.85})));
}

TEST(OccupancyMap, LeavesOutGroundAndPad) {
  OccupancyMap map(SmallMap());
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  PadOutline pad;
  pad.p_WP = {2.4, 0.0, 1.0};
  pad.half_size = 0.5;
  for (int i = 0; i < 3; ++i) map.Integrate(WallFrame(p_WC, 2.0), pad);
  const CellIndex front = map.CellOf({2.01, 0.05, 0.85});
  EXPECT_FALSE(map.IsOccupied(front));
  EXPECT_FALSE(map.IsObservedFree(front));                       // it was seen, and not as free
  EXPECT_TRUE(map.IsOccupied(map.CellOf({2.01, 0.05, 1.15})));   // above its top
  EXPECT_TRUE(map.IsOccupied(map.CellOf({2.01, 0.75, 0.85})));   // beside it
  EXPECT_FALSE(map.IsOccupied(map.CellOf({2.01, 0.75, 0.05})));  // ground
}

// A wall 0.7 m high, 1.6 m before a pad known only by a coarse GPS: before, all of it was erased.
TEST(OccupancyMap, ReturnsThatMayBeThePadsAreKeptUntilThePadIsKnown) {
  OccupancyMap map(SmallMap());
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  PadOutline coarse;
  coarse.p_WP = {2.6, 0.0, 1.0};
  coarse.half_size = 0.5;
  coarse.sigma = 0.5;
  estimation::DepthFrame frame = WallFrame(p_WC, 2.0);
  frame.t = 7.0;
  map.Integrate(frame, coarse);
  const CellIndex pad_cell = map.CellOf({2.01, 0.05, 0.85}), post = map.CellOf({2.01, 1.05, 0.85});
  for (const CellIndex& cell : {pad_cell, post}) {
    EXPECT_TRUE(map.IsDoubtful(cell));
    EXPECT_FALSE(map.IsOccupied(cell));
    EXPECT_FALSE(map.IsObservedFree(cell));
  }
  ExpectInflationIsConsistent(map);
  // The tags show where the pad was at that time: one cell was its front, the other was not it.
  map.ExplainDoubts([&](double t) {
    EXPECT_EQ(t, 7.0);
    PadOutline known = coarse;
    known.sigma = 0.01;
    return known;
  });
  EXPECT_FALSE(map.IsDoubtful(pad_cell));
  EXPECT_FALSE(map.IsKnown(pad_cell));
  EXPECT_TRUE(map.IsOccupied(post));
  ExpectInflationIsConsistent(map);
}

// Seen from afar, returns of the deck lie above it by the camera's noise. They became obstacles in the way.
TEST(OccupancyMap, ReturnsThatMayBeThePadsAreExplainedWithTheirNoise) {
  OccupancyMapOptions options = SmallMap();
  options.range_noise = 0.02;
  OccupancyMap map(options);
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  PadOutline pad;
  pad.p_WP = {2.6, 0.0, 0.7};
  pad.half_size = 0.5;
  pad.sigma = 0.5;
  map.Integrate(WallFrame(p_WC, 2.0), pad);
  const CellIndex noisy = map.CellOf({2.01, 0.05, 0.85}), above = map.CellOf({2.01, 0.05, 1.05});
  EXPECT_TRUE(map.IsDoubtful(noisy));
  EXPECT_TRUE(map.IsOccupied(above));
  pad.sigma = 0.01;
  map.ExplainDoubts([&](double) { return pad; });
  EXPECT_FALSE(map.IsKnown(noisy));
  EXPECT_TRUE(map.IsOccupied(above));
  ExpectInflationIsConsistent(map);
}

TEST(OccupancyMap, RollingKeepsWhatStaysAndForgetsWhatLeaves) {
  OccupancyMap map(SmallMap());
  Draw draw(11);
  for (int step = 0; step < 8; ++step) {
    for (int i = 0; i < 6; ++i) {
      map.SetOccupied(map.CentreOf(map.origin()) + Eigen::Vector3d{draw.Uniform(0, 6.3),
                                                                   draw.Uniform(0, 6.3),
                                                                   draw.Uniform(0, 1.5)});
    }
    std::set<std::array<int, 3>> kept;
    CellIndex c;
    const CellIndex lo = map.origin(), hi = map.origin() + map.size();
    for (c.z() = lo.z(); c.z() < hi.z(); ++c.z()) {
      for (c.y() = lo.y(); c.y() < hi.y(); ++c.y()) {
        for (c.x() = lo.x(); c.x() < hi.x(); ++c.x()) {
          if (map.IsOccupied(c)) kept.insert({c.x(), c.y(), c.z()});
        }
      }
    }
    const Eigen::Vector3d centre =
        map.CentreOf(map.origin() + map.size() / 2) + draw.Vector(step % 4 == 3 ? 8.0 : 1.5);
    map.Recentre(centre);
    for (const auto& [x, y, z] : kept) {
      const CellIndex cell(x, y, z);
      EXPECT_EQ(map.IsOccupied(cell), map.InWindow(cell));
    }
    ExpectInflationIsConsistent(map);
  }
}

TEST(OccupancyMap, MovesInThinSlicesOfOneAxis) {
  OccupancyMap map(OccupancyMapOptions{});
  const auto off_centre = [&](const Eigen::Vector3d& p) -> CellIndex {
    return (map.CellOf(p) - map.size() / 2 - map.origin()).cwiseAbs();
  };
  int moves = 0;
  Eigen::Vector3d p(0.05, 0.05, 0.05);
  for (int step = 0; step < 200; ++step, p += Eigen::Vector3d(0.3, -0.2, 0.02)) {
    map.Recentre(p);
    EXPECT_LT(off_centre(p).maxCoeff(), 8);
    if (map.entered().empty()) continue;
    ++moves;
    ASSERT_EQ(map.entered().size(), 1u);
    EXPECT_LE((map.entered()[0].high - map.entered()[0].low).minCoeff(), 8);
  }
  EXPECT_GT(moves, 100);
  map.Recentre(p + Eigen::Vector3d(5.0, 5.0, 0.0));
  EXPECT_EQ(off_centre(p + Eigen::Vector3d(5.0, 5.0, 0.0)), CellIndex::Zero()) << "it jumped";
}

// Rows are stored around the window's end, in words of 64 cells or in a part of one.
TEST(OccupancyMap, ARowOfBitsSaysWhatItsCellsSay) {
  Draw draw(17);
  for (const int log2_x : {4, 5, 6, 7, 8}) {
    OccupancyMapOptions options = SmallMap();
    options.size_log2.x() = log2_x;
    options.inflation_radius = 0.0;
    OccupancyMap map(options);
    map.MoveWindow({static_cast<int>(draw.Uniform(-300.0, 300.0)), -9, -5});
    ASSERT_NE(map.origin().x() % map.size().x(), 0) << "the window's rows do not wrap around";
    const int size = map.size().x();
    CellIndex cell = map.origin() + CellIndex(0, 3, 2);
    for (int i = 0; i < size; i += 1 + i % 3) {
      map.SetOccupied(map.CentreOf(cell + CellIndex(i, 0, 0)));
    }
    int blocked = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const int count = static_cast<int>(draw.Uniform(1.0, std::min(64, size) + 0.99));
      const int from = static_cast<int>(draw.Uniform(0.0, size - count + 0.99));
      const CellIndex first = cell + CellIndex(from, 0, 0);
      const std::uint64_t bits = map.BlockedRow(first, count);
      for (int i = 0; i < 64; ++i) {
        const bool wanted = i < count && map.IsBlocked(CellIndex(first + CellIndex(i, 0, 0)));
        ASSERT_EQ((bits >> i & 1u) != 0, wanted) << size << " " << from << " " << count << " " << i;
        blocked += wanted;
      }
    }
    EXPECT_GT(blocked, 200);
  }
}

TEST(OccupancyMap, InflationLeavesNothingBehind) {
  for (const double radius : {0.0, 0.3, 1.0}) {  // the last ball is wider than the window
    OccupancyMapOptions options = SmallMap();
    options.size_log2 = {4, 4, 4};
    options.inflation_radius = radius;
    OccupancyMap map(options);
    Draw draw(5);
    for (int step = 0; step < 6; ++step) {
      for (int i = 0; i < 5; ++i) {
        map.SetOccupied(map.CentreOf(map.origin()) + Eigen::Vector3d{draw.Uniform(0, 1.5),
                                                                     draw.Uniform(0, 1.5),
                                                                     draw.Uniform(0, 1.5)});
      }
      ExpectInflationIsConsistent(map);
      map.Recentre(map.CentreOf(map.origin() + map.size() / 2) + draw.Vector(0.5));
      ExpectInflationIsConsistent(map);
    }
    map.Recentre({100.0, 0.0, 0.0});
    map.Recentre(Eigen::Vector3d::Zero());
    ExpectInflationIsConsistent(map);
    EXPECT_FALSE(map.IsBlocked(Eigen::Vector3d(0.0, 0.0, 0.0)));
  }
}

/// A frame from anywhere in any direction: near and far returns, none, and invalid pixels.
estimation::DepthFrame AnyFrame(Draw* draw, const Eigen::Vector3d& about) {
  estimation::DepthFrame frame;
  frame.p_WC = about + draw->Vector(0.6);
  frame.R_WC =
      Eigen::AngleAxisd{draw->Uniform(0.0, 3.0), draw->Vector(1.0).normalized()}.toRotationMatrix();
  frame.max_range = 4.0;
  for (int i = 0; i < 80 * 60; ++i) {
    const double kind = draw->Uniform(0.0, 1.0);
    float depth = static_cast<float>(draw->Uniform(0.05, 3.0));
    if (kind < 0.3) depth = std::numeric_limits<float>::infinity();
    if (kind > 0.98) depth = std::numeric_limits<float>::quiet_NaN();
    frame.depth.push_back(depth);
  }
  return frame;
}

enum class Seen { kNot, kMissed, kPad, kHit };

/// The documented rule, with a traversal per ray.
std::map<std::array<int, 3>, Seen> SeenCells(const OccupancyMap& map,
                                             const estimation::DepthFrame& frame,
                                             const PadOutline& pad) {
  std::map<std::array<int, 3>, Seen> seen;
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const double depth = frame.depth[static_cast<std::size_t>(v * k.width + u)];
      if (std::isnan(depth)) continue;
      const Eigen::Vector3d ray((u + 0.5 - k.cx) / k.focal, (v + 0.5 - k.cy) / k.focal, 1.0);
      const bool returned = std::isfinite(depth);
      const double along = returned ? depth : frame.max_range / ray.norm();
      const double range = along * ray.norm();
      if (range < map.options().min_ray || range > 1.0001 * frame.max_range) continue;
      const double freed = std::min(along, map.options().thinnest_obstacle * k.focal);
      const Eigen::Vector3d end = frame.p_WC + frame.R_WC * ray * along;
      const Eigen::Vector3d free_end = frame.p_WC + frame.R_WC * ray * freed;
      const auto see = [&](const CellIndex& cell, Seen as) {
        Seen& cell_seen = seen[{cell.x(), cell.y(), cell.z()}];
        cell_seen = std::max(cell_seen, as);
      };
      TraverseCells(frame.p_WC, free_end, map.resolution(), [&](const CellIndex& cell) {
        if (!map.InWindow(cell)) return false;
        if (cell != map.CellOf(free_end)) see(cell, Seen::kMissed);
        return true;
      });
      if (!returned || end.z() <= map.options().ground_height) continue;
      if (!map.InWindow(map.CellOf(end))) continue;
      const bool of_pad = pad.Classify(end, map.resolution()) == ReturnKind::kPad;
      see(map.CellOf(end), of_pad ? Seen::kPad : Seen::kHit);
    }
  }
  return seen;
}

TEST(OccupancyMap, UpdatesWhatATraversalOfEveryRayVisits) {
  Draw draw(5);
  PadOutline pad;
  pad.p_WP = {0.5, 0.3, 0.5};
  pad.half_size = 0.6;
  int hits = 0, misses = 0;
  for (int round = 0; round < 12; ++round) {
    OccupancyMap map(SmallMap());
    const Eigen::Vector3d about{draw.Uniform(-20, 20), draw.Uniform(-20, 20), draw.Uniform(0, 2)};
    map.Recentre(about);
    const estimation::DepthFrame frame = AnyFrame(&draw, about);
    const auto seen = SeenCells(map, frame, pad);
    map.Integrate(frame, pad);
    int wrong = 0;
    ForEachCell({map.origin(), map.origin() + map.size()}, [&](const CellIndex& cell) {
      const auto found = seen.find({cell.x(), cell.y(), cell.z()});
      const Seen expected = found == seen.end() ? Seen::kNot : found->second;
      hits += expected == Seen::kHit;
      misses += expected == Seen::kMissed;
      wrong += map.IsOccupied(cell) != (expected == Seen::kHit);
      wrong += map.IsObservedFree(cell) != (expected == Seen::kMissed);
    });
    EXPECT_EQ(wrong, 0) << "round " << round;
  }
  EXPECT_GT(hits, 5000);
  EXPECT_GT(misses, 30000);
}

TEST(OccupancyMap, ACellIsUpdatedOnceAFrameWithinTheClamps) {
  OccupancyMap map(SmallMap());
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  const CellIndex wall = map.CellOf({2.01, 0.05, 0.85}), before = map.CellOf({0.5, 0.05, 0.85});
  const auto log_odds = [&](const CellIndex& cell) {
    std::vector<CellValue> changes;
    OccupancyMap copy = map;
    copy.TakeChanges(&changes);
    for (const CellValue& value : changes) {
      if (value.cell == cell) return static_cast<int>(value.log_odds);
    }
    return 0;
  };
  // Logits of 0.65, 0.35, 0.12 and 0.90 in steps of 1/16; dozens of rays pass the cell before.
  for (const int hit : {10, 20, 30, 35, 35}) {
    map.Integrate(WallFrame(p_WC, 2.0), {});
    EXPECT_EQ(log_odds(wall), hit);
    EXPECT_EQ(log_odds(before), std::max(-hit, -32));
  }
}

TEST(OccupancyMap, SaysNothingFromOutOfTheWindow) {
  OccupancyMap map(SmallMap());
  map.Integrate(WallFrame({50.0, 0.0, 0.85}, 52.0), {});
  map.Integrate(WallFrame({0.0, std::nan(""), 0.85}, 2.0), {});
  std::vector<CellValue> changes;
  map.TakeChanges(&changes);
  EXPECT_TRUE(changes.empty());
}

TEST(OccupancyMap, RefusesAFrameWithTooFewDepths) {
  OccupancyMap map(SmallMap());
  estimation::DepthFrame frame = WallFrame({0.05, 0.05, 0.85}, 2.0);
  frame.depth.pop_back();
  EXPECT_THROW(map.Integrate(frame, {}), std::invalid_argument);
}

// An impossible depth frees nothing: anything may be behind it.
TEST(OccupancyMap, APixelThatIsNoneSaysNothing) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float depth : {0.0F, -1.0F, 4.5F, 2000.0F, -kInfinity, std::nanf("")}) {
    OccupancyMap map(SmallMap());
    const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
    map.Recentre(p_WC);
    estimation::DepthFrame frame = WallFrame(p_WC, 2.0);
    std::fill(frame.depth.begin(), frame.depth.end(), depth);
    map.Integrate(frame, {});
    EXPECT_EQ(map.CountObservedFree(), 0) << depth;
    std::fill(frame.depth.begin(), frame.depth.end(), kInfinity);
    map.Integrate(frame, {});
    EXPECT_GT(map.CountObservedFree(), 0) << depth;
  }
}

int CountOf(const CellBlocks& memory) {
  int count = 0;
  memory.ForEach([&](const CellValue&) { ++count; });
  return count;
}

TEST(OccupancyMap, HandsOutWhatLeavesAndTakesItBackWithoutChange) {
  OccupancyMap map(SmallMap());
  const Eigen::Vector3d p_WC(0.05, 0.05, 0.85);
  map.Recentre(p_WC);
  map.Integrate(WallFrame(p_WC, 2.0), {});
  const OccupancyMap before = map;
  CellBlocks memory;
  map.Recentre(p_WC + Eigen::Vector3d(-5.0, 0.0, 0.0), &memory);
  EXPECT_GT(CountOf(memory), 1000);
  ASSERT_EQ(map.entered().size(), 1u);
  EXPECT_EQ(map.entered()[0].high.x() - map.entered()[0].low.x(), 50);
  EXPECT_FALSE(map.IsKnown(map.CellOf({2.01, 0.05, 0.85})));
  map.Recentre(p_WC);
  memory.ForEach([&](const CellValue& value) { map.Restore(value); });
  int wrong = 0;
  ForEachCell({map.origin(), map.origin() + map.size()}, [&](const CellIndex& cell) {
    wrong += map.IsOccupied(cell) != before.IsOccupied(cell) ||
             map.IsKnown(cell) != before.IsKnown(cell) ||
             map.IsBlocked(cell) != before.IsBlocked(cell);
  });
  EXPECT_EQ(wrong, 0);
  ExpectInflationIsConsistent(map);
  CellBlocks anew;
  map.Recentre(p_WC + Eigen::Vector3d(-5.0, 0.0, 0.0), &anew);
  EXPECT_EQ(CountOf(anew), 0);  // nothing was seen anew
}

TEST(OccupancyMap, LeavesOutTheGroundOfWhatIsRestored) {
  OccupancyMap map(SmallMap());
  map.Restore({map.CellOf({0.05, 0.05, 0.05}), 30});
  map.Restore({map.CellOf({0.05, 0.05, 0.15}), 127});
  map.Restore({map.CellOf({9.0, 0.05, 0.15}), 30});  // out of the window
  EXPECT_FALSE(map.IsKnown(map.CellOf({0.05, 0.05, 0.05})));
  EXPECT_TRUE(map.IsOccupied(map.CellOf({0.05, 0.05, 0.15})));
  std::vector<CellState> states;
  map.CopyStates(&states);
  EXPECT_EQ(std::count(states.begin(), states.end(), CellState::kOccupied), 1);
}

TEST(OccupancyMap, DoesNotAllocateOnceItsListsHaveGrown) {
  Draw draw(6);
  OccupancyMap map(SmallMap());
  const estimation::DepthFrame frame = AnyFrame(&draw, {0.0, 0.0, 0.8});
  map.Integrate(frame, {});
  const long before = solvers::AllocationCount();
  map.Integrate(frame, {});
  map.Recentre({1.0, 0.0, 0.8});
  EXPECT_EQ(solvers::AllocationCount(), before);
}

TEST(OccupancyMap, RefusesBadOptions) {
  OccupancyMapOptions options;
  options.resolution = 0.0;
  EXPECT_THROW(OccupancyMap{options}, std::invalid_argument);
  options = {};
  options.probability_hit = 0.4;
  EXPECT_THROW(OccupancyMap{options}, std::invalid_argument);
  options = {};
  options.size_log2.x() = 2;
  EXPECT_THROW(OccupancyMap{options}, std::invalid_argument);
}

// An impossible camera must not reach beyond the grid.
TEST(OccupancyMap, AnImpossibleCameraSaysNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::function<void(estimation::DepthFrame*)> slips[] = {
      [](auto* f) { f->intrinsics.cx = kNan; },   [](auto* f) { f->intrinsics.cy = 1e308; },
      [](auto* f) { f->intrinsics.cx = -1e308; }, [](auto* f) { f->intrinsics.focal = kNan; },
      [](auto* f) { f->intrinsics.focal = 0.0; }, [](auto* f) { f->intrinsics.focal = 1e-300; },
      [](auto* f) { f->max_range = kNan; },       [](auto* f) { f->R_WC.setZero(); },
      [](auto* f) { f->R_WC *= 1e200; },          [](auto* f) { f->R_WC.col(0) *= -1.0; },
      [](auto* f) { f->p_WC.x() = 1e10; },        [](auto* f) { f->p_WC.y() = -1e300; },
      [](auto* f) { f->p_WC.z() = kNan; },
  };
  for (const float depth : {2.0F, std::numeric_limits<float>::infinity()}) {
    for (const auto& slip : slips) {
      OccupancyMap map{OccupancyMapOptions{}};
      map.Recentre({0.0, 0.0, 2.0});
      estimation::DepthFrame frame;
      frame.p_WC = {0.0, 0.0, 2.0};
      frame.R_WC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
      frame.depth.assign(80 * 60, depth);
      slip(&frame);
      map.Integrate(frame, {});
      EXPECT_EQ(map.CountObservedFree(), 0);
    }
  }
}

}  // namespace
}  // namespace touchdown::planning
