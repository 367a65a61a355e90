// SPDX-License-Identifier: BSD-3-Clause
// The cells that the next stops may not enter, against a look at every cell.

#include "touchdown/planning/certify/unseen_zone.h"

#include <gtest/gtest.h>

#include "planning/test/hull_fixtures.h"
#include "planning/test/replanner_fixtures.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

/// A cell is closed if one that is missing is within the hull's radius and half a cell, centre to centre.
/// A cell is missing if it is not observed free and the hull does not touch it at the start already.
bool ClosedByHand(const OccupancyMap& map, const Eigen::Vector3d& start, const CellIndex& cell) {
  const double reach = kHull / map.resolution() + 0.5;
  const int n = static_cast<int>(reach);
  bool closed = false;
  ForEachCell({CellIndex(-n, -n, -n), CellIndex(n + 1, n + 1, n + 1)}, [&](const CellIndex& off) {
    const CellIndex at = cell + off;
    if (off.cast<double>().squaredNorm() > reach * reach || map.IsObservedFree(at)) return;
    if ((at.z() + 1) * map.resolution() <= map.options().ground_height + 1e-9) return;
    closed = closed || DistanceToCell(map, at, start) >= kHull;
  });
  return closed;
}

class Zone : public ::testing::TestWithParam<double> {};

TEST_P(Zone, IsWhereTheHullWouldTouchWhatIsUnseen) {
  const double reach = GetParam();
  Draw draw(1);
  const auto zone = std::make_unique<UnseenZone>();
  int closed = 0, open = 0;
  for (int trial = 0; trial < 12; ++trial) {
    OccupancyMapOptions options = NoGround();
    if (trial % 3 == 0) options.ground_height = -0.25;
    OccupancyMap map = RandomMap(&draw, 20, 0.2, options);
    const FreeSpace space = SpaceOf(map);
    const Eigen::Vector3d start = draw.Vector(0.4);
    zone->Build(HullOf(space), start, reach);
    const CellIndex centre = map.CellOf(start);
    const int kept = static_cast<int>(std::min(reach, UnseenZone::kFarthest) / 0.1);
    const CellIndex around = CellIndex::Constant(kept + 2);
    ForEachCell({centre - around, centre + around + CellIndex::Ones()}, [&](const CellIndex& cell) {
      const bool near = (cell - centre).cwiseAbs().maxCoeff() <= kept;
      // Where the hull is already it may be, whatever the rounding of the lattice.
      const bool wanted = near && cell != centre && ClosedByHand(map, start, cell);
      ASSERT_EQ(zone->Holds(cell), wanted) << trial << " at " << (cell - centre).transpose();
      (wanted ? closed : open) += 1;
    });
  }
  EXPECT_GT(closed, 1000);
  EXPECT_GT(open, 1000);
}

INSTANTIATE_TEST_SUITE_P(Reach, Zone, ::testing::Values(0.5, 1.0, 1.2));

// The zone only helps to find a plan; the tube is what is proven. It closes where the ball around a
// cell's centre reaches into an unseen cell along an axis. It spares corners by less than a cell's
// diagonal.
TEST(UnseenZone, ClosesWhatTheHullTouchesButForCorners) {
  Draw draw(2);
  const auto zone = std::make_unique<UnseenZone>();
  for (int trial = 0; trial < 6; ++trial) {
    const OccupancyMap map = RandomMap(&draw, 12, 0.8);
    const FreeSpace space = SpaceOf(map);
    zone->Build(HullOf(space), {0.05, 0.05, 0.05}, 1.0);
    ForEachCell({CellIndex(-10, -10, -10), CellIndex(11, 11, 11)}, [&](const CellIndex& cell) {
      const Eigen::Vector3d p = map.CentreOf(cell);
      const double corner = (0.5 * std::sqrt(3.0) - 0.5) * map.resolution();
      if (zone->Holds(cell)) {
        EXPECT_FALSE(BallInFree(map, p, kHull + 1e-9)) << trial;
      } else {
        EXPECT_TRUE(BallInFree(map, p, kHull - corner - 1e-9)) << trial;
      }
    });
  }
}

TEST(UnseenZone, RowsAreItsCells) {
  Draw draw(4);
  const OccupancyMap map = RandomMap(&draw, 20, 0.3);
  const FreeSpace space = SpaceOf(map);
  const auto zone = std::make_unique<UnseenZone>();
  zone->Build(HullOf(space), {0.3, -0.2, 0.1}, 1.2);
  for (int trial = 0; trial < 2000; ++trial) {
    const CellIndex first = (draw.Vector(45.0)).cast<int>();
    const int count = 1 + static_cast<int>(draw.Uniform(0.0, 63.9));
    const std::uint64_t row = zone->Row(first, count);
    for (int i = 0; i < 64; ++i) {
      const bool held = i < count && zone->Holds(first + CellIndex(i, 0, 0));
      ASSERT_EQ((row >> i & 1u) != 0, held);
    }
  }
}

TEST(UnseenZone, ClosesASpaceWithoutBlockingTheMap) {
  OccupancyMap map(NoGround());
  map.MarkRestFree();
  for (int y = -32; y < 32; ++y) {
    for (int z = -16; z < 16; ++z) map.SetState({8, y, z}, CellState::kUnknown);
  }
  FreeSpace space = SpaceOf(map);
  const auto zone = std::make_unique<UnseenZone>();
  zone->Build(HullOf(space), {0.05, 0.05, 0.05}, 1.0);
  const Eigen::Vector3d before(0.55, 0.05, 0.05);
  EXPECT_FALSE(space.Blocked(before));
  space.unseen = zone.get();
  EXPECT_TRUE(space.Blocked(before));
  EXPECT_TRUE(space.Blocked(map.CellOf(before)));
  EXPECT_NE(space.ClosedRow(map.CellOf({0.05, 0.05, 0.05}), 10), 0u);
  EXPECT_FALSE(space.Blocked(Eigen::Vector3d(0.05, 0.05, 0.05)));
}

TEST(UnseenZone, DoesNotAllocate) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  Draw draw(5);
  const OccupancyMap map = RandomMap(&draw, 20, 0.3);
  const FreeSpace space = SpaceOf(map);
  const auto zone = std::make_unique<UnseenZone>();
  const long before = solvers::AllocationCount();
  zone->Build(HullOf(space), {0.0, 0.0, 0.0}, 1.0);
  EXPECT_EQ(solvers::AllocationCount(), before);
}

/// Flying towards a pad behind a block of unseen cells.
class TowardsTheUnseen : public ::testing::Test {
 protected:
  TowardsTheUnseen()
      : map_(ObservedMap()),
        pad_({5.0, 0.0, 0.3}, 0.0, 0.0, 0.0),
        replanner_(Options(ArrivalMode::kFixed), solvers::StandardBackends()) {}

  void Hide(double x) {
    ForEachCell({map_.CellOf({x, -0.6, 0.0}), map_.CellOf({x + 0.4, 0.6, 3.0})},
                [&](const CellIndex& cell) { map_.SetState(cell, CellState::kUnknown); });
  }

  const ReplanResult& Ask(double t, ReplanLog* log = nullptr) {
    const FlatState at = replanner_.Reference(t);
    ReplanInput input = Input(at.p_WB, pad_, t);
    input.vehicle.v_WB = at.v_WB;
    replanner_.set_log(log);
    return replanner_.Replan(input, map_);
  }

  OccupancyMap map_;
  ArcPad pad_;
  Replanner replanner_;
};

TEST_F(TowardsTheUnseen, StepsAfterAWayAroundItLeadAroundItAtOnce) {
  replanner_.CommitHover({-1.0, 0.0, 1.6}, 0.0);
  Hide(-0.3);
  double t = 0.0;
  for (; t < 3.0 && !replanner_.state().around_unseen; t += 0.1) Ask(t);
  ASSERT_TRUE(replanner_.state().around_unseen);
  for (int step = 0; step < 3 && replanner_.state().around_unseen; ++step, t += 0.1) {
    ReplanLog log;
    ASSERT_EQ(Ask(t, &log).status, ReplanStatus::kPlanned) << t;
    EXPECT_EQ(log.attempts.size(), 1U) << "no straight attempt before it, at " << t;
  }
}

}  // namespace
}  // namespace touchdown::planning
