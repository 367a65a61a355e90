// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/blocked_bits.h"

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

// All that FreeSpace and the barriers say, at every cell of the window and across its edges.
TEST(BlockedBits, SayWhatTheSpaceAndTheBarriersSay) {
  Draw draw(11);
  BlockedBits bits;
  for (int trial = 0; trial < 6; ++trial) {
    OccupancyMapOptions options = SmallMap(0.15);
    options.size_log2 = trial % 2 == 0 ? Eigen::Vector3i(7, 5, 4) : Eigen::Vector3i(4, 5, 5);
    OccupancyMap map(options);
    // Anywhere in the window's storage, which wraps around.
    map.Recentre({draw.Uniform(-20, 20), draw.Uniform(-20, 20), draw.Uniform(-1, 1)});
    const Eigen::Vector3d low = map.CentreOf(map.origin());
    const Eigen::Vector3d extent = map.size().cast<double>() * map.resolution();
    const auto anywhere = [&] {
      return Eigen::Vector3d(
          low +
          Eigen::Vector3d{draw.Uniform(0, 1), draw.Uniform(0, 1), draw.Uniform(0, 1)}.cwiseProduct(
              extent));
    };
    for (int i = 0; i < 40; ++i) map.SetOccupied(anywhere());
    FreeSpace space = SpaceOf(map);
    space.floor = low.z() + 0.3;
    space.ceiling = low.z() + extent.z() - 0.3;
    space.pad_radius = 0.5;
    space.pad_floor = space.floor + draw.Uniform(-0.3, 0.3);
    space.pad_from = anywhere().head<2>();
    space.pad_to = anywhere().head<2>();
    std::vector<Barrier> barriers(2);
    for (Barrier& barrier : barriers) {
      barrier.p = anywhere();
      barrier.normal = Eigen::Vector3d{draw.Uniform(-1, 1), draw.Uniform(-1, 1), 0}.normalized();
      barrier.side = barrier.normal.cross(Eigen::Vector3d::UnitZ());
    }
    if (trial < 2) barriers.clear();
    bits.Begin(space, barriers);
    const auto blocked = [&](const CellIndex& cell) {
      if (!map.InWindow(cell)) return false;
      if (space.Blocked(cell)) return true;
      for (const Barrier& barrier : barriers) {
        if (Closes(barrier, map.CentreOf(cell), map.resolution())) return true;
      }
      return false;
    };
    int wrong = 0, set = 0;
    ForEachCell({CellIndex::Zero(), bits.size()}, [&](const CellIndex& at) {
      const bool in_word = (bits.Word(at.y(), at.z(), at.x() / 64) >> (at.x() % 64) & 1u) != 0;
      wrong += in_word != blocked(map.origin() + at);
      const std::uint32_t around = bits.Around(at);
      int bit = 0;
      ForEachCell({at.array() - 1, at.array() + 2}, [&](const CellIndex& cell) {
        const bool says = (around >> bit++ & 1u) != 0;
        set += says;
        wrong += says != blocked(map.origin() + cell);
      });
    });
    EXPECT_EQ(wrong, 0) << "trial " << trial;
    EXPECT_GT(set, 1000);
  }
}

}  // namespace
}  // namespace touchdown::planning
