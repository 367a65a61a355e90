// SPDX-License-Identifier: BSD-3-Clause
// Whether a return of the depth camera may come from the pad, given the pad's uncertainty.

#include "touchdown/planning/map/pad_outline.h"

#include <gtest/gtest.h>

#include "planning/test/small_map.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {
namespace {

PadOutline Deck(double sigma) {
  PadOutline pad;
  pad.p_WP = {1.0, 2.0, 0.4};
  pad.yaw = 0.3;
  pad.half_size = 0.5;
  pad.sigma = sigma;
  return pad;
}

/// In the pad's axes from the deck's centre.
Eigen::Vector3d Place(const PadOutline& pad, double along, double left, double up) {
  const double c = std::cos(pad.yaw), s = std::sin(pad.yaw);
  return pad.p_WP + Eigen::Vector3d(c * along - s * left, s * along + c * left, up);
}

TEST(PadOutline, DistanceBesideIsToTheTurnedSquare) {
  const PadOutline pad = Deck(0.0);
  EXPECT_EQ(DistanceBeside(pad, Place(pad, 0.49, -0.49, 7.0)), 0.0);
  EXPECT_NEAR(DistanceBeside(pad, Place(pad, 0.8, 0.1, -1.0)), 0.3, 1e-12);
  EXPECT_NEAR(DistanceBeside(pad, Place(pad, -0.8, 0.9, 0.0)), 0.5, 1e-12);
}

TEST(PadOutline, AKnownPadExplainsWhatItFillsAndNoMore) {
  Draw draw(1);
  int explained = 0, obstacles = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const PadOutline pad = Deck(draw.Uniform(0.0, 0.05));
    ASSERT_TRUE(pad.Known());
    const double tolerance = draw.Uniform(0.0, 0.2);
    const Eigen::Vector3d at{draw.Uniform(-1.5, 1.5), draw.Uniform(-1.5, 1.5),
                             draw.Uniform(-0.5, 0.5)};
    const double beside = Eigen::Array2d(at.head<2>().array().abs() - 0.5).max(0.0).matrix().norm();
    const bool pad_may_be_there = at.z() <= tolerance && beside <= 3.0 * pad.sigma + tolerance;
    EXPECT_EQ(pad.Classify(Place(pad, at.x(), at.y(), at.z()), tolerance),
              pad_may_be_there ? ReturnKind::kPad : ReturnKind::kObstacle);
    (pad_may_be_there ? explained : obstacles) += 1;
  }
  EXPECT_GT(explained, 100);
  EXPECT_GT(obstacles, 100);
}

// The wall of the issue: 0.7 m high, 1.6 m before a pad that is known by a coarse GPS. It was erased.
TEST(PadOutline, WithACoarseFixAWallBeforeThePadIsInDoubtNotGone) {
  PadOutline pad = Deck(0.4);
  pad.p_WP.z() = 0.8;
  EXPECT_FALSE(pad.Known());
  EXPECT_FALSE(pad.SurelyOver(pad.p_WP));
  EXPECT_EQ(pad.Classify(Place(pad, 1.6, 0.0, -0.1), 0.1), ReturnKind::kDoubtful);
  EXPECT_EQ(pad.Classify(Place(pad, 1.6, 0.0, 0.3), 0.1), ReturnKind::kObstacle)
      << "above the deck";
  EXPECT_EQ(pad.Classify(Place(pad, 2.0, 0.0, -0.1), 0.1), ReturnKind::kObstacle)
      << "beyond 3 sigma";
  EXPECT_EQ(pad.Classify(Place(pad, 0.0, 0.0, -0.1), 0.1), ReturnKind::kDoubtful);
}

TEST(PadOutline, WithoutAPadEverythingIsAnObstacle) {
  EXPECT_EQ(PadOutline{}.Classify({0, 0, 0}, 1.0), ReturnKind::kObstacle);
}

TEST(PadOutline, SigmaBoundsTheWorstDirection) {
  Draw draw(2);
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::Matrix2d root;
    root << draw.Uniform(-1, 1), draw.Uniform(-1, 1), draw.Uniform(-1, 1), draw.Uniform(-1, 1);
    estimation::PadState state;
    state.cov_p = root * root.transpose();
    const double worst = root.jacobiSvd().singularValues()[0];
    EXPECT_GE(OutlineOf(state, 0.5).sigma, worst - 1e-12);
    EXPECT_EQ(OutlineOf(state, 0.5).half_size, 0.5);
  }
}

/// One pixel straight down from 3 m above the ground at p_W, at time t, whose ray ends `height` above it.
estimation::DepthFrame DownAt(const Eigen::Vector3d& p_W, double height, double t) {
  estimation::DepthFrame frame;
  frame.t = t;
  frame.intrinsics = {1, 1, 100.0, 0.5, 0.5};
  frame.p_WC = {p_W.x(), p_W.y(), 1.5};
  frame.R_WC << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  frame.max_range = 6.0;
  frame.depth = {static_cast<float>(1.5 - height)};
  return frame;
}

// Doubtful returns are neither free nor occupied, until the pad's place at their time settles them.
TEST(PadOutline, DoubtsAreSettledByWhereThePadWasThen) {
  OccupancyMap map(SmallMap(0.2));
  PadOutline doubt = Deck(0.4);
  doubt.yaw = 0.0;
  doubt.p_WP = {0.0, 0.0, 0.45};
  const Eigen::Vector3d pad_then(0.05, 0.05, 0.45), post(1.05, 0.05, 0.45);
  map.Integrate(DownAt(pad_then, 0.45, 1.0), doubt);
  map.Integrate(DownAt(post, 0.45, 2.0), doubt);
  for (const Eigen::Vector3d& p : {pad_then, post}) {
    EXPECT_TRUE(map.IsDoubtful(map.CellOf(p)));
    EXPECT_FALSE(map.IsOccupied(map.CellOf(p)));
    EXPECT_FALSE(map.IsObservedFree(map.CellOf(p)));
  }
  // It drove at 1 m/s: at the second return's time it was 0.6 m behind the post, not at it.
  const auto outline_at = [&](double t) {
    PadOutline known = doubt;
    known.half_size = 0.3;
    known.sigma = 0.01;
    known.p_WP.x() = t - 1.0 - (t > 1.5 ? 0.7 : 0.0);
    return known;
  };
  map.ExplainDoubts(outline_at);
  EXPECT_FALSE(map.IsOccupied(map.CellOf(pad_then)));
  EXPECT_FALSE(map.IsKnown(map.CellOf(pad_then))) << "nothing is known of it, not that it is free";
  EXPECT_FALSE(map.IsObservedFree(map.CellOf(pad_then)));
  EXPECT_TRUE(map.IsOccupied(map.CellOf(post)));
}

// A vehicle that saw the side of a pad for 20 s before it knew where that is: it became an
// obstacle below the goal.
TEST(PadOutline, ReturnsThatAreInDoubtForLongAreNoObstacles) {
  OccupancyMap map(SmallMap(0.2));
  PadOutline doubt = Deck(0.4);
  doubt.p_WP = {0.0, 0.0, 0.45};
  const Eigen::Vector3d side(0.05, 0.05, 0.45);
  for (int i = 0; i < 16385; ++i) map.Integrate(DownAt(side, 0.45, 0.1 * i), doubt);
  EXPECT_FALSE(map.IsOccupied(map.CellOf(side)));
  EXPECT_TRUE(map.IsDoubtful(map.CellOf(side)));
  EXPECT_FALSE(map.IsObservedFree(map.CellOf(side)));
  PadOutline known = doubt;
  known.sigma = 0.01;
  known.p_WP.x() = 2.0;
  map.ExplainDoubts([&](double) { return known; });
  EXPECT_TRUE(map.IsOccupied(map.CellOf(side))) << "it was not there";
}

}  // namespace
}  // namespace touchdown::planning
