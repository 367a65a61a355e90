// SPDX-License-Identifier: BSD-3-Clause
// What happens when the vehicle touches something.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"
#include "sim/world/world.h"

namespace touchdown::sim {
namespace {

using Thrusts = Eigen::Vector4d;
using Kind = PadMotionConfig::Kind;

const Thrusts kOff = Thrusts::Zero();

bool Touches(const World& world, ContactKind kind) {
  return std::any_of(world.contacts().begin(), world.contacts().end(),
                     [&](const Contact& contact) { return contact.kind == kind; });
}

// Runs with the rotors off until something touches, at most `seconds`.
void FallUntilContact(double seconds, World* world) {
  while (world->contacts().empty() && world->time() < seconds) world->Step(kOff);
}

// The vehicle's centre in the pad's frame.
Eigen::Vector3d OnPad(const World& world) {
  const estimation::PadState pad = world.pad();
  return Eigen::AngleAxisd(-pad.yaw, Eigen::Vector3d::UnitZ()) * (world.vehicle().p_WB - pad.p_WP);
}

// Above the pad's centre by `gap` from the soles, moving and turning with it.
WorldConfig AbovePad(Kind kind, double gap) {
  WorldConfig config;
  config.pad_motion.kind = kind;
  config.pad_motion.heading = 0.7;
  const estimation::PadState pad = PadMotion(config.pad_motion).At(0.0);
  config.start.p_WB = pad.p_WP + Eigen::Vector3d(0.0, 0.0, 0.12 + gap);
  config.start.v_WB = pad.v_WP;
  config.start.w_WB_B.z() = pad.yaw_rate;
  return config;
}

TEST(WorldContact, DroppedOnTheMovingPadItStays) {
  for (const Kind kind : {Kind::kLine, Kind::kCircle, Kind::kStraightTurn}) {
    World world(AbovePad(kind, 0.05));
    FallUntilContact(1.0, &world);
    ASSERT_TRUE(Touches(world, ContactKind::kFootDeck));
    const Eigen::Vector3d touched = OnPad(world);
    while (world.time() < 15.0) {
      world.Step(kOff);
      ASSERT_FALSE(Touches(world, ContactKind::kHullDeck));
    }
    EXPECT_LT((OnPad(world) - touched).head<2>().norm(), 0.005);
    EXPECT_NEAR(OnPad(world).z(), 0.12, 0.005);
    EXPECT_LT(estimation::Tilt(world.vehicle().q_WB), 0.01);
    EXPECT_LT(world.velocity_over_deck().norm(), 1e-3);
    // At rest the feet carry the weight.
    EXPECT_NEAR(world.foot_force().force, world.model().HoverThrust(), 0.02 * 11.6);
    EXPECT_EQ(world.foot_force().t, world.time());
  }
}

TEST(WorldContact, FirstContactHoldsTheVelocityBeforeTheImpact) {
  WorldConfig config = AbovePad(Kind::kLine, 0.2);
  config.start.v_WB.x() += 0.3;
  World world(config);
  Eigen::Vector3d before = world.velocity_over_deck();
  while (world.contacts().empty() && world.time() < 1.0) {
    before = world.velocity_over_deck();
    world.Step(kOff);
  }
  ASSERT_EQ(world.contacts().size(), 4U);
  for (const Contact& contact : world.contacts()) {
    EXPECT_EQ(contact.kind, ContactKind::kFootDeck);
    EXPECT_EQ(contact.obstacle, -1);
    EXPECT_LT((contact.v_rel_W - before).norm(), 1e-3);
    EXPECT_LT(contact.v_rel_W.z(), -1.0);
    EXPECT_NEAR(contact.v_rel_W.x(), 0.3, 0.05);  // less what drag took
    EXPECT_NEAR(contact.p_W.z(), 0.3, 0.005);
    EXPECT_GT(contact.normal_force, 0.0);
  }
}

TEST(WorldContact, FrictionOfTheDeckIsTheConfiguredOne) {
  // Sliding with 0.5 m/s on a deck of friction mu stops after v^2 / (2 mu g).
  WorldConfig config = AbovePad(Kind::kStatic, 0.002);
  config.pad.friction = 0.1;
  config.start.v_WB.x() = 0.5;
  World world(config);
  FallUntilContact(1.0, &world);
  const double from = OnPad(world).head<2>().norm();
  while (world.time() < 2.0) world.Step(kOff);
  const double slid = OnPad(world).head<2>().norm() - from;
  EXPECT_NEAR(slid, 0.25 / (2.0 * 0.1 * estimation::kGravity), 0.03);
}

TEST(WorldContact, UpsideDownItIsTheHull) {
  WorldConfig config = AbovePad(Kind::kStatic, 0.1);
  config.start.q_WB = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  World world(config);
  FallUntilContact(1.0, &world);
  EXPECT_TRUE(Touches(world, ContactKind::kHullDeck));
  EXPECT_FALSE(Touches(world, ContactKind::kFootDeck));
  EXPECT_EQ(world.foot_force().force, 0.0);
}

TEST(WorldContact, ObstacleIsNamedByItsIndex) {
  WorldConfig config = test::OpenSky();
  config.obstacles = ObstacleField({Box{{0.0, 30.0, 5.0}, {1.0, 1.0, 5.0}, 0.0},
                                    Cylinder{{3.0, 0.0, 5.0}, 0.5, 10.0},
                                    Box{{0.0, -30.0, 5.0}, {1.0, 1.0, 5.0}, 0.3}});
  config.start.v_WB.x() = 3.0;
  World world(config);
  const double hover = world.model().HoverThrust() / 4.0;
  while (world.contacts().empty() && world.time() < 2.0)
    world.Step(Eigen::Vector4d(hover, hover, hover, hover));
  ASSERT_FALSE(world.contacts().empty());
  const Contact& contact = world.contacts().front();
  EXPECT_EQ(contact.kind, ContactKind::kObstacle);
  EXPECT_EQ(contact.obstacle, 1);
  EXPECT_NEAR(contact.p_W.x(), 2.5, 0.02);
  EXPECT_NEAR(world.vehicle().p_WB.x(), 2.2, 0.02);
  EXPECT_GT(contact.v_rel_W.x(), 2.0);
}

TEST(WorldContact, FeetMeetObstaclesToo) {
  WorldConfig config = test::OpenSky();
  config.obstacles = ObstacleField({Box{{0.0, 0.0, 4.0}, {1.0, 1.0, 0.5}, 0.2}});
  World world(config);
  FallUntilContact(2.0, &world);
  ASSERT_TRUE(Touches(world, ContactKind::kObstacle));
  EXPECT_NEAR(world.contacts().front().p_W.z(), 4.5, 0.01);
}

TEST(WorldContact, Ground) {
  WorldConfig config = test::OpenSky();
  config.start.p_WB.z() = 0.5;
  World world(config);
  FallUntilContact(2.0, &world);
  EXPECT_TRUE(Touches(world, ContactKind::kGround));
  EXPECT_NEAR(world.vehicle().p_WB.z(), 0.12, 0.01);
}

TEST(WorldContact, PadVehicleBesideItsDeck) {
  WorldConfig config = AbovePad(Kind::kStatic, 0.1);
  config.pad.deck_half_size = 0.3;
  config.pad.body_half_length = 1.5;
  config.pad.body_half_width = 0.6;
  config.start.p_WB += Eigen::Vector3d(std::cos(0.7), std::sin(0.7), 0.0);
  World world(config);
  FallUntilContact(1.0, &world);
  EXPECT_TRUE(Touches(world, ContactKind::kPadVehicle));
  EXPECT_FALSE(Touches(world, ContactKind::kFootDeck));
}

TEST(WorldContact, PadPassesObstaclesAndStaysOnItsHeight) {
  WorldConfig config = test::OpenSky();
  config.pad_motion.kind = Kind::kLine;
  config.pad_motion.p_start.x() = 10.0;
  config.obstacles = ObstacleField({Box{{12.0, 0.0, 1.0}, {0.5, 0.5, 1.0}, 0.0}});
  World world(config);
  const double hover = world.model().HoverThrust() / 4.0;
  while (world.time() < 5.0) {
    world.Step(Eigen::Vector4d(hover, hover, hover, hover));
    ASSERT_TRUE(world.contacts().empty());
  }
  EXPECT_NEAR(world.pad().p_WP.x(), 14.0, 0.003);
}

TEST(WorldContact, KindsHaveNames) {
  EXPECT_STREQ(ToString(ContactKind::kFootDeck), "foot-deck");
  EXPECT_STREQ(ToString(ContactKind::kHullDeck), "hull-deck");
  EXPECT_STREQ(ToString(ContactKind::kPadVehicle), "pad-vehicle");
  EXPECT_STREQ(ToString(ContactKind::kObstacle), "obstacle");
  EXPECT_STREQ(ToString(ContactKind::kGround), "ground");
}

// Bits of every state of a flight that ends on the moving pad, wind and obstacles about it.
std::vector<std::uint64_t> Flight() {
  RandomStream random(31, "determinism");
  WorldConfig config = AbovePad(Kind::kStraightTurn, 0.3);
  config.obstacles = test::RandomField(10, 3.0, &random);
  config.obstacles = ObstacleField([&] {
    std::vector<Obstacle> kept;
    for (const Obstacle& obstacle : config.obstacles.obstacles()) {
      if (SignedDistance(obstacle, config.start.p_WB) > 0.5) kept.push_back(obstacle);
    }
    return kept;
  }());
  World world(config);
  std::vector<std::uint64_t> bits;
  for (int i = 0; i < 2000; ++i) {
    const double thrust = random.Uniform(0.0, 4.0);
    world.Step(Eigen::Vector4d(thrust, thrust, thrust, thrust),
               test::RandomPoint({-3, -3, -1}, {3, 3, 1}, &random));
    const estimation::VehicleState state = world.vehicle();
    for (const double x : state.p_WB) bits.push_back(std::bit_cast<std::uint64_t>(x));
    for (const double x : state.q_WB.coeffs()) bits.push_back(std::bit_cast<std::uint64_t>(x));
    bits.push_back(std::bit_cast<std::uint64_t>(world.foot_force().force));
    bits.push_back(std::bit_cast<std::uint64_t>(world.pad().p_WP.x()));
  }
  return bits;
}

TEST(WorldContact, SameBitsAgainAndInThreads) {
  const std::vector<std::uint64_t> once = Flight();
  EXPECT_EQ(Flight(), once);
  std::vector<std::uint64_t> first;
  std::vector<std::uint64_t> second;
  std::thread one([&] { first = Flight(); });
  std::thread two([&] { second = Flight(); });
  one.join();
  two.join();
  EXPECT_EQ(first, once);
  EXPECT_EQ(second, once);
}

}  // namespace
}  // namespace touchdown::sim
