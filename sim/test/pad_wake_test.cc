// SPDX-License-Identifier: BSD-3-Clause
#include "sim/air/pad_wake.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace touchdown::sim {
namespace {

estimation::PadState Pad(const Eigen::Vector3d& v_W) {
  estimation::PadState pad;
  pad.p_WP = {0.0, 0.0, 0.5};
  pad.v_WP = v_W;
  return pad;
}

TEST(PadWake, NothingUpstreamAndNothingInStillAir) {
  const Eigen::Vector3d wind(5.0, 0.0, 0.0);
  EXPECT_EQ(PadWake({}, Pad({0, 0, 0}), wind, {-0.5, 0.0, 0.7}), Eigen::Vector3d::Zero());
  EXPECT_EQ(PadWake({}, Pad({0, 0, 0}), {0, 0, 0}, {1.0, 0.0, 0.7}), Eigen::Vector3d::Zero());
  EXPECT_EQ(PadWake({}, Pad(wind), wind, {1.0, 0.0, 0.7}), Eigen::Vector3d::Zero());
}

TEST(PadWake, SlowsTheWindBehind) {
  const Eigen::Vector3d wake = PadWake({}, Pad({0, 0, 0}), {6.0, 0.0, 0.0}, {2.0, 0.0, 0.3});
  EXPECT_LT(wake.x(), -0.5);
  EXPECT_GT(wake.x(), -6.0);
  EXPECT_EQ(wake.y(), 0.0);
  EXPECT_LT(std::abs(PadWake({}, Pad({0, 0, 0}), {6.0, 0.0, 0.0}, {2.0, 0.0, 3.0}).x()), 1e-3);
}

TEST(PadWake, MovingPadDragsStillAirAlong) {
  EXPECT_GT(PadWake({}, Pad({0.0, 3.0, 0.0}), {0, 0, 0}, {0.0, -1.5, 0.3}).y(), 0.1);
}

TEST(PadWake, CarriesTheMomentumOfTheDrag) {
  // At any distance behind the first diameter, the deficit's momentum, integrated across the flow,
  // is C/2 times the frontal area. So the wake is that of a disc of equal area.
  const PadGeometry geometry;
  const double board = 2.0 * geometry.deck_half_size * geometry.deck_thickness;
  const double box =
      2.0 * geometry.body_half_width * (0.5 - geometry.deck_thickness - geometry.ground_gap);
  for (const double x : {1.0, 4.0}) {
    const double step = 0.02;
    double momentum = 0.0;
    for (double y = -4.0; y < 4.0; y += step) {
      for (double z = -4.0; z < 4.0; z += step) {
        const double share = -PadWake(geometry, Pad({0, 0, 0}), {1.0, 0.0, 0.0}, {x, y, z}).x();
        momentum += (1.0 - share) * share * step * step;
      }
    }
    EXPECT_NEAR(momentum, 0.5 * 0.9 * (board + box), 0.002) << x;
  }
}

TEST(PadWake, DoesNotJump) {
  double last = 0.0;
  for (double x = -0.5; x < 3.0; x += 0.005) {
    const double now = PadWake({}, Pad({0, 0, 0}), {10.0, 0.0, 0.0}, {x, 0.1, 0.6}).x();
    EXPECT_LT(std::abs(now - last), 0.1) << x;
    last = now;
  }
}

}  // namespace
}  // namespace touchdown::sim
