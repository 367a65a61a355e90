// SPDX-License-Identifier: BSD-3-Clause
// Blocks of cells: against a plain map of cells, their reach, their filling, and without allocation.

#include "touchdown/planning/map/cell_blocks.h"

#include <array>
#include <map>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

TEST(CellBlocks, KeepTheLatestValueOfEveryCell) {
  Draw draw(4);
  CellBlocks blocks;
  std::map<std::array<int, 3>, int> wanted;
  for (int i = 0; i < 4000; ++i) {
    // Around the origin, where indices change sign, and at both ends of what is kept.
    const double far = std::array{0.0, -32760.0, 32759.0}[static_cast<std::size_t>(i) % 3];
    const CellIndex cell = (draw.Vector(8.0).array() + far).matrix().cast<int>();
    const auto log_odds = static_cast<std::int8_t>(draw.Uniform(-127.0, 127.0));
    blocks.Put({cell, log_odds});
    wanted[{cell.x(), cell.y(), cell.z()}] = log_odds;
  }
  std::map<std::array<int, 3>, int> found;
  blocks.ForEach([&](const CellValue& value) {
    const CellIndex& cell = value.cell;
    ASSERT_NE(blocks.Find(cell), nullptr);
    EXPECT_EQ((*blocks.Find(cell))[cell], value.log_odds);
    found[{cell.x(), cell.y(), cell.z()}] = value.log_odds;
  });
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(blocks.Find({100, 0, 0}), nullptr);
}

TEST(CellBlocks, LeaveOutWhatIsTooFar) {
  CellBlocks blocks;
  for (const int far : {CellBlocks::kReach, -CellBlocks::kReach - 1}) {
    for (int axis = 0; axis < 3; ++axis) blocks.Put({far * CellIndex::Unit(axis), 10});
  }
  blocks.ForEach([](const CellValue& value) { ADD_FAILURE() << value.cell.transpose(); });
}

TEST(CellBlocks, BeginWithWhatIsKnownOtherwise) {
  int asked = 0;
  CellBlocks blocks([&](const CellIndex& low, CellBlock* block) {
    ++asked;
    EXPECT_EQ(low, CellIndex(-8, 0, 8));
    (*block)[low + CellIndex(1, 2, 3)] = 20;
    (*block)[low] = 20;
  });
  blocks.Put({{-8, 0, 8}, -30});
  blocks.Put({{-1, 7, 15}, -30});
  const CellBlock& block = *blocks.Find({-8, 0, 8});
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(block[CellIndex(-8, 0, 8)], -30);
  EXPECT_EQ(block[CellIndex(-7, 2, 11)], 20);
  EXPECT_EQ(block[CellIndex(-6, 2, 11)], kUnknownLogOdds);
}

TEST(CellBlocks, DoNotAllocateUpToWhatIsReserved) {
  CellBlocks blocks;
  const long before = solvers::AllocationCount();
  for (int i = 0; i < static_cast<int>(CellBlocks::kReserved); ++i) {
    blocks.Put({CellBlock::kSide * CellIndex(i % 64, i / 64, 0), 1});
  }
  EXPECT_EQ(solvers::AllocationCount(), before);
  for (int i = 0; i < static_cast<int>(CellBlocks::kReserved); ++i) {
    blocks.Put({CellBlock::kSide * CellIndex(i % 64, i / 64, 1), 1});
  }
  EXPECT_NE(blocks.Find({0, 0, 0}), nullptr);  // and beyond it nothing is lost
}

}  // namespace
}  // namespace touchdown::planning
