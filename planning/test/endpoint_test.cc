// SPDX-License-Identifier: BSD-3-Clause
// The moving endpoint: offsets, approach velocity and derivatives with respect to the arrival time.

#include "touchdown/planning/spline/endpoint.h"

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

TEST(Endpoint, IsThePadPlusItsHeight) {
  const ArcPad pad({1, 2, 0.3}, 0.8, 0.4, 0.2);
  const EndState end = EndStateAt(pad, {0.0, 1.5, 0.0, 1.5}, 3.0);
  EXPECT_LT((end.state.p - pad.At(3.0).p_WP - Eigen::Vector3d(0, 0, 1.5)).norm(), 1e-14);
  EXPECT_LT((end.state.v - pad.At(3.0).v_WP).norm(), 1e-14);
}

TEST(Endpoint, SinksAtItsRateDownToItsFloor) {
  const ArcPad pad({1, 2, 0.3}, 0.8, 0.4, 0.0);
  const EndpointTarget target{1.0, 1.5, 0.5, 0.2};
  EXPECT_NEAR(EndStateAt(pad, target, 2.0).state.p.z(), 0.3 + 1.0, 1e-14);
  EXPECT_NEAR(EndStateAt(pad, target, 2.0).state.v.z(), -0.5, 1e-14);
  EXPECT_NEAR(EndStateAt(pad, target, 9.0).state.p.z(), 0.3 + 0.2, 1e-14);
  EXPECT_NEAR(EndStateAt(pad, target, 9.0).state.v.z(), 0.0, 1e-14);
}

TEST(Endpoint, APointThatIsPassedStandsWhenItIsMetLater) {
  const ArcPad pad({1, 2, 0.3}, 0.0, 0.0, 0.2);
  EndpointTarget target{0.0, 0.0};
  target.passing_W = {1.5, -0.5, 0.1};
  for (const double t : {1.0, 4.0}) {
    const EndState end = EndStateAt(pad, target, t);
    EXPECT_EQ(end.state.v, pad.At(t).v_WP + target.passing_W);
    EXPECT_EQ(end.derivative.p, pad.At(t).v_WP);
    EXPECT_EQ(end.derivative.v, pad.At(t).a_WP);
  }
}

TEST(Endpoint, ContactIsMetSinkingAtTheDeck) {
  Draw draw(43);
  const ArcPad pad = draw.Pad();
  const EndpointTarget target{0.0, 0.2, 0.0, 0.2, 0.3};
  for (const double t : {1.0, 4.0}) {
    const EndState end = EndStateAt(pad, target, t);
    const estimation::PadState at = pad.At(t);
    EXPECT_EQ(end.state.p, at.p_WP + Eigen::Vector3d(0.0, 0.0, 0.2));
    EXPECT_EQ(end.state.v, at.v_WP - Eigen::Vector3d(0.0, 0.0, 0.3));
    EXPECT_EQ(end.derivative.p, at.v_WP);  // a later arrival is no lower
  }
  EXPECT_TRUE(target.touches());
  EXPECT_FALSE((EndpointTarget{0.0, 1.5, 0.3, 0.2}.touches()));
}

TEST(Endpoint, AtRestItIsWhereThePadWillBeAndOnlySinks) {
  const ArcPad pad({1, 2, 0.3}, 0.8, 0.4, 0.2);
  EndpointTarget target{0.0, 0.2, 0.0, 0.2, 0.3};
  target.at_rest = true;
  const EndState end = EndStateAt(pad, target, 4.0);
  EXPECT_EQ(end.state.p, pad.At(4.0).p_WP + Eigen::Vector3d(0.0, 0.0, 0.2));
  EXPECT_EQ(end.state.v, Eigen::Vector3d(0.0, 0.0, -0.3));
  EXPECT_EQ(end.state.a, Eigen::Vector3d::Zero());
  EXPECT_EQ(end.derivative.p, pad.At(4.0).v_WP) << "a later arrival is elsewhere";
}

TEST(Endpoint, DerivativesMatchDifferences) {
  Draw draw(41);
  const double d = 1e-5;
  for (int trial = 0; trial < 50; ++trial) {
    const ArcPad pad = draw.Pad();
    EndpointTarget target{0.0, 2.0, 0.1, 0.2, trial % 2 == 0 ? 0.0 : 0.3};
    target.at_rest = trial % 3 == 0;
    const double t = draw.Uniform(0.5, 8.0);
    const EndState at = EndStateAt(pad, target, t), plus = EndStateAt(pad, target, t + d),
                   minus = EndStateAt(pad, target, t - d);
    EXPECT_LT(((plus.state.p - minus.state.p) / (2 * d) - at.derivative.p).norm(), 1e-8);
    EXPECT_LT(((plus.state.v - minus.state.v) / (2 * d) - at.derivative.v).norm(), 1e-8);
    EXPECT_LT(((plus.state.a - minus.state.a) / (2 * d) - at.derivative.a).norm(), 1e-8);
    EXPECT_LT(((plus.derivative.p - minus.derivative.p) / (2 * d) - at.second_derivative.p).norm(),
              1e-8);
    EXPECT_LT(((plus.derivative.v - minus.derivative.v) / (2 * d) - at.second_derivative.v).norm(),
              1e-8);
  }
}

}  // namespace
}  // namespace touchdown::planning
