// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/certify/margins.h"

#include <gtest/gtest.h>

namespace touchdown::planning {
namespace {

TEST(Margins, CalmFlightWithATrueStateStaysNarrow) {
  const Margins calm = MarginsOf(0.0, 0.0, 0.0, 0.0);
  EXPECT_EQ(calm.own_state, 0.0);
  EXPECT_EQ(calm.attitude, 0.0);
  EXPECT_GT(calm.tracking, 0.0);
  EXPECT_LT(calm.Sum(), Margins().Sum());
}

TEST(Margins, EachGrowsWithWhatItPaysForAlone) {
  const Margins calm = MarginsOf(0.0, 0.0, 0.0, 0.0);
  const Margins lost = MarginsOf(0.02, 0.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(lost.own_state, 0.06);
  EXPECT_EQ(lost.tracking, calm.tracking);
  EXPECT_LT(MarginsOf(5.0, 0.0, 0.0, 0.0).own_state, 0.1)
      << "who does not know where in W it is still knows how far it has come";
  EXPECT_GT(MarginsOf(0.0, 0.01, 0.0, 0.0).attitude, 0.0);
  EXPECT_DOUBLE_EQ(MarginsOf(0.0, 0.0, 0.3, 0.0).tracking, 0.3);
  const Margins windy = MarginsOf(0.0, 0.0, 0.0, 1.0);
  EXPECT_GT(windy.tracking, calm.tracking);
  EXPECT_DOUBLE_EQ(windy.Sum(), windy.own_state + windy.attitude + windy.tracking);
}

TEST(RecentError, IsTheLargestOfLateAndFades) {
  RecentError recent;
  recent.Note(1.0, 0.2);
  EXPECT_EQ(recent.value(), 0.2);
  recent.Note(1.1, 0.05);
  EXPECT_GT(recent.value(), 0.15);
  EXPECT_LT(recent.value(), 0.2);
  recent.Note(1.2, 0.4);
  EXPECT_EQ(recent.value(), 0.4);
  recent.Note(1.2 + 10.0 * RecentError::kFade, 0.0);
  EXPECT_LT(recent.value(), 1e-4);
}

}  // namespace
}  // namespace touchdown::planning
