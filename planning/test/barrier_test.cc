// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/barrier.h"

#include <gtest/gtest.h>

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

FlatState Flying(const Vector3d& p, const Vector3d& v) {
  FlatState state;
  state.p_WB = p;
  state.v_WB = v;
  return state;
}

TEST(Barrier, ClosesTheSideOnWhichThePathPasses) {
  const std::vector<Vector3d> left = {{-1, 0, 1}, {0, 0.8, 1}, {1, 0, 1}};
  const std::optional<Barrier> barrier = ClosePath(left, Flying({0, 0, 1}, {2, 0, 0}));
  ASSERT_TRUE(barrier.has_value());
  EXPECT_TRUE(barrier->side.isApprox(Vector3d::UnitY()));
  EXPECT_TRUE(Closes(*barrier, {0.04, 0.5, 1.2}, 0.1));
  EXPECT_FALSE(Closes(*barrier, {0.04, -0.5, 1.2}, 0.1));  // the other side
  EXPECT_FALSE(Closes(*barrier, {0.0, 0.0, 2.0}, 0.1));    // above is a third way
  EXPECT_FALSE(Closes(*barrier, {0.2, 0.5, 1.2}, 0.1));    // off the plane
}

TEST(Barrier, AStateAtRestTakesThePathsDirection) {
  const std::vector<Vector3d> over = {{0, -1, 1}, {0, 0, 1.9}, {0, 1, 1}};
  const std::optional<Barrier> barrier = ClosePath(over, Flying({0, 0, 1}, Vector3d::Zero()));
  ASSERT_TRUE(barrier.has_value());
  EXPECT_TRUE(barrier->normal.isApprox(Vector3d::UnitY()));
  EXPECT_TRUE(barrier->side.isApprox(Vector3d::UnitZ()));
}

TEST(Barrier, APathThroughTheStateHasNoSide) {
  const std::vector<Vector3d> through = {{-1, 0, 1}, {0, 0.001, 1}, {1, 0, 1}};
  EXPECT_FALSE(ClosePath(through, Flying({0, 0, 1}, {1, 0, 0})).has_value());
}

TEST(Barrier, WithoutADirectionThereIsNone) {
  const FlatState still = Flying({0, 0, 1}, Vector3d::Zero());
  EXPECT_FALSE(ClosePath({}, still).has_value());
  const std::vector<Vector3d> one = {{0, 0.5, 1}};
  EXPECT_FALSE(ClosePath(one, still).has_value());
}

}  // namespace
}  // namespace touchdown::planning
