// SPDX-License-Identifier: BSD-3-Clause
// The pad motion of docs/adding_a_pad_motion.md.
#include "lane_change.h"

#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

#include "touchdown/sim/pad/pad_course.h"

namespace own {
namespace {

touchdown::sim::PathCourse Course(double angle) {
  const double speed = 1.2, curvature = std::copysign(0.4 / speed, angle);
  const LaneChangeTurns turns = {
      .after = 3.0, .angle = angle, .curvature = curvature, .ramp = 0.5 * speed};
  return {LaneChange({7.0, 0.0}, 0.0, turns), 0.3, speed, 0.0};
}

TEST(LaneChange, GoesOnInItsOldDirectionBesideItsOldWay) {
  for (const double angle : {0.6, -0.6}) {
    const auto motion = Course(angle);
    const touchdown::estimation::PadState before = motion.At(0.0), after = motion.At(30.0);
    EXPECT_NEAR(after.yaw, before.yaw, 1e-9);
    EXPECT_GT(std::copysign(1.0, angle) * after.p_WP.y(), 1.0);
    EXPECT_NEAR(after.v_WP.y(), 0.0, 1e-9);
    EXPECT_NEAR(motion.At(2.0).p_WP.y(), 0.0, 1e-12);
  }
}

TEST(LaneChange, DerivativesAreExactAndWithinTheBounds) {
  const auto motion = Course(0.6);
  constexpr double kStep = 1e-5;
  for (double t = 0.05; t < 12.0; t += 0.1) {
    const auto at = motion.At(t), next = motion.At(t + kStep), last = motion.At(t - kStep);
    EXPECT_LT(((next.p_WP - last.p_WP) / (2 * kStep) - at.v_WP).norm(), 1e-7);
    EXPECT_LT(((next.v_WP - last.v_WP) / (2 * kStep) - at.a_WP).norm(), 1e-7);
    EXPECT_LE(at.a_WP.norm(), motion.bounds().acceleration + 1e-12);
  }
}

}  // namespace
}  // namespace own
