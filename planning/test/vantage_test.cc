// SPDX-License-Identifier: BSD-3-Clause
#include "planning/certify/vantage.h"

#include <gtest/gtest.h>

#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

const Eigen::Vector3d kCalm(0.0, 0.0, 0.0);

TEST(Vantage, TheMiddleOfTheImageIsWhereTheNosePoints) {
  EXPECT_DOUBLE_EQ(OffSight({2, 0, 1}, {0, 0, 1}, kCalm), 0.0);
  EXPECT_NEAR(OffSight({1, 1, 1}, {0, 0, 1 + std::sqrt(2.0)}, kCalm), M_PI / 4, 1e-12);
  // Pulled forward the vehicle leans back: the nose is up.
  const Eigen::Vector3d pull(estimation::kGravity, 0, 0);
  EXPECT_NEAR(OffSight({1, 0, 1}, {0, 0, 0}, pull), 0.0, 1e-12);
  EXPECT_NEAR(OffSight({-1, 0, 1}, {0, 0, 0}, pull), M_PI / 2, 1e-12);
  EXPECT_NEAR(OffSight({0, 1, 0}, {0, 0, 0}, pull), 0.0, 1e-12) << "it rolls alone";
}

TEST(Vantage, EveryPlaceIsBetterAndTheBestComesFirst) {
  const Eigen::Vector3d p(0, 0, 2), below(0.4, 0.1, 1.6);
  for (const Eigen::Vector3d& pull :
       {kCalm, Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(-3, 2, 0), Eigen::Vector3d(0, -4, 0)}) {
    const Vantages vantages(p, below, pull);
    ASSERT_GT(vantages.size(), 3U);
    double last = 0.0;
    for (const Eigen::Vector3d& shift : vantages) {
      EXPECT_LE(shift.norm(), Vantages::kFarthest + 1e-12);
      const double off = OffSight(below, p + shift, pull);
      EXPECT_LT(off, OffSight(below, p, pull));
      EXPECT_GE(off, last);
      last = off;
    }
  }
}

TEST(Vantage, WhatIsInTheMiddleHasNoBetterPlace) {
  EXPECT_EQ(Vantages({0, 0, 2}, {3, 0, 2.1}, kCalm).size(), 0U);
}

TEST(Vantage, DoesNotAllocate) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  const long before = solvers::AllocationCount();
  const Vantages vantages({0, 0, 2}, {0.3, 0, 2.5}, kCalm);
  EXPECT_EQ(solvers::AllocationCount(), before);
  EXPECT_GT(vantages.size(), 0U);
}

}  // namespace
}  // namespace touchdown::planning
