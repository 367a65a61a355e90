// SPDX-License-Identifier: BSD-3-Clause
// The planner of docs/adding_a_planner.md, flown by a vehicle that tracks perfectly.
#include "straight_planner.h"

#include <gtest/gtest.h>

#include "touchdown/planning/certify/certificate.h"

namespace own {
namespace {

using Eigen::Vector3d;

class StraightPad : public touchdown::estimation::PadPrediction {
 public:
  explicit StraightPad(double speed) : speed_(speed) {}
  touchdown::estimation::PadState At(double t) const noexcept override {
    touchdown::estimation::PadState pad;
    pad.p_WP = {6.0 + speed_ * t, 1.0, 0.3};
    pad.v_WP = {speed_, 0.0, 0.0};
    return pad;
  }

 private:
  double speed_;
};

class ExamplePlanner : public testing::Test {
 protected:
  ExamplePlanner() : planner(Limits{.speed = 3.0, .acceleration = 6.0}), map({}) {
    planner.CommitHover({0.0, 0.0, 2.0}, 0.0);
  }

  ReplanInput InputAt(double t) {
    ReplanInput input;
    input.t_now = t;
    input.t_start = t + 0.02;
    input.pad = pad;
    input.endpoint = {t, 1.5, 0.0, 1.5};
    return input;
  }

  const touchdown::estimation::PadPrediction* pad = nullptr;
  StraightPlanner planner;
  OccupancyMap map;
};

TEST_F(ExamplePlanner, ComesAboveAMovingPadAndFollows) {
  const StraightPad moving(0.8);
  pad = &moving;
  double t = 0.0;
  for (; t < 10.0; t += 0.1) {
    const FlatState before = planner.Reference(t + 0.02);
    const ReplanResult& result = planner.Replan(InputAt(t), map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned);
    EXPECT_LE(BoundDerivatives(result.curve).speed, 3.0);
    const FlatState after = planner.Reference(t + 0.02);
    ASSERT_LT((after.p_WB - before.p_WB).norm(), 1e-9);
    ASSERT_LT((after.v_WB - before.v_WB).norm(), 1e-9);
  }
  const FlatState at = planner.Reference(t);
  const touchdown::estimation::PadState now = moving.At(t);
  EXPECT_LT((at.p_WB - now.p_WP - Vector3d(0.0, 0.0, 1.5)).norm(), 1e-3);
  EXPECT_LT((at.v_WB - now.v_WP).norm(), 1e-3);
}

TEST_F(ExamplePlanner, BrakesWithoutAPadAndForOneItCannotReach) {
  EXPECT_EQ(planner.Replan(InputAt(0.0), map).status, ReplanStatus::kBraking);
  const StraightPad fast(9.0);
  pad = &fast;
  const ReplanResult& result = planner.Replan(InputAt(0.1), map);
  EXPECT_EQ(result.status, ReplanStatus::kBraking);
  EXPECT_EQ(result.reason, ReplanReason::kPadUnreachable);
  EXPECT_LT((planner.Reference(20.0).p_WB - Vector3d(0.0, 0.0, 2.0)).norm(), 1e-9);
}

TEST_F(ExamplePlanner, ClimbsOnceHoweverOftenItIsAsked) {
  for (double t = 0.0; t < 5.0; t += 0.1) {
    EXPECT_EQ(planner.Rest(InputAt(t), 1.5, map).status, ReplanStatus::kClimbing);
  }
  EXPECT_NEAR(planner.Reference(20.0).p_WB.z(), 3.5, 1e-9);
}

}  // namespace
}  // namespace own
