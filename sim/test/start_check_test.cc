// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/start_check.h"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <typename Change>
std::string Refusal(const Change& change) {
  WorldConfig config = test::OpenSky();
  change(&config);
  return test::MessageOf<std::invalid_argument>([&] { World world(config); });
}

TEST(StartCheck, FreeStartsAreTaken) {
  EXPECT_EQ(Refusal([](WorldConfig*) {}), "");
  EXPECT_EQ(Refusal([](WorldConfig* c) {
              c->obstacles = ObstacleField({Box{{1.31, 0.0, 5.0}, {1.0, 1.0, 5.0}, 0.0}});
            }),
            "");
  EXPECT_EQ(Refusal([](WorldConfig* c) { c->start.p_WB.z() = 0.121; }), "");
}

TEST(StartCheck, ObstacleOnTopOfTheStartIsNamed) {
  EXPECT_THAT(Refusal([](WorldConfig* c) {
                c->obstacles = ObstacleField({Box{{9.0, 9.0, 1.0}, {1.0, 1.0, 1.0}, 0.0},
                                              Box{{1.2, 0.0, 5.0}, {1.0, 1.0, 5.0}, 0.0}});
              }),
              AllOf(HasSubstr("obstacle 1"), HasSubstr("is -0.1"), HasSubstr("> 0")));
}

TEST(StartCheck, PadAndGroundAreNamed) {
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->start.p_WB = {20.9, 0.0, 0.3}; }), HasSubstr("pad"));
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->start.p_WB.z() = 0.119; }),
              HasSubstr("height above the ground [m] is -0.00"));
  EXPECT_THAT(Refusal([](WorldConfig* c) {
                c->start.p_WB.z() = 0.2;
                c->start.q_WB = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
              }),
              HasSubstr("ground"));
}

TEST(StartCheck, NumbersAreNamedWithTheirRange) {
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->start.v_WB.x() = std::nan(""); }),
              HasSubstr("start state"));
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->start.q_WB.coeffs() *= 2.0; }),
              HasSubstr("norm of q_WB is 2"));
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->timestep = 0.01; }),
              HasSubstr("timestep [s] is 0.01; allowed is [0.0001, 0.005]"));
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->pad.friction = 0.0; }),
              HasSubstr("pad.friction is 0"));
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->pad_motion.p_start.z() = 0.05; }),
              HasSubstr("pad deck height is 0.05; allowed is [0.09"));
  EXPECT_THAT(Refusal([](WorldConfig* c) { c->vehicle_mjcf = "<mujoco/>"; }),
              HasSubstr("\"vehicle\""));
}

}  // namespace
}  // namespace touchdown::sim
