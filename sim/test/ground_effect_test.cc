// SPDX-License-Identifier: BSD-3-Clause
#include "sim/air/ground_effect.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "sim/air/drag.h"
#include "sim/test/scenes.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::sim {
namespace {

const estimation::Commands kThrusts = Eigen::Vector4d::Constant(3.0);

estimation::VehicleState At(double x, double y, double z) {
  estimation::VehicleState vehicle;
  vehicle.p_WB << x, y, z;
  return vehicle;
}

// A deck of 1.5 m, 0.5 m above the ground at the origin.
Box Deck() { return {{0.0, 0.0, 0.485}, {0.75, 0.75, 0.015}, 0.0}; }

TEST(GroundEffect, RatioByHand) {
  EXPECT_NEAR(GroundEffectRatio(0.13, 0.13, 3.0, 0.0), 16.0 / 15.0, 1e-12);
  EXPECT_NEAR(GroundEffectRatio(0.13, 10.0, 3.0, 0.0), 1.0, 1e-4);
  // At the induced velocity itself half of the effect's share is left.
  const double inflow = std::sqrt(3.0 / (2.0 * 1.225 * std::acos(-1.0) * 0.13 * 0.13));
  EXPECT_NEAR(GroundEffectRatio(0.13, 0.13, 3.0, inflow), 32.0 / 31.0, 1e-12);
  EXPECT_EQ(GroundEffectRatio(0.13, 0.0, 3.0, 0.0), GroundEffectRatio(0.13, 0.065, 3.0, 0.0));
  EXPECT_EQ(GroundEffectRatio(0.13, 0.1, 0.0, 0.0), 1.0);
}

TEST(GroundEffect, LiftsOverTheDeckWithoutMoment) {
  const estimation::VehicleModel model = LoadVehicleModel(DefaultVehicleMjcf());
  const GroundEffect over = GroundEffectOf(model, At(0.0, 0.0, 0.62), kThrusts, Deck(), 0.0);
  const GroundEffect beside = GroundEffectOf(model, At(3.0, 0.0, 0.62), kThrusts, Deck(), 0.0);
  EXPECT_GT(over.thrust, 0.03 * 12.0);
  EXPECT_LT(beside.thrust, 0.2 * over.thrust);  // the ground is half a metre farther down
  EXPECT_LT(over.moment_B.norm(), 1e-12);
}

TEST(GroundEffect, AtTheEdgeTheSideOverTheDeckIsLifted) {
  const estimation::VehicleModel model = LoadVehicleModel(DefaultVehicleMjcf());
  // The right half is over the deck: lifted there, it rolls to the left, negative about x.
  const GroundEffect left_edge = GroundEffectOf(model, At(0.0, 0.75, 0.62), kThrusts, Deck(), 0.0);
  EXPECT_LT(left_edge.moment_B.x(), -1e-3);
  EXPECT_NEAR(left_edge.moment_B.y(), 0.0, 1e-12);
}

TEST(GroundEffect, WorldFeelsItOnlyIfAsked) {
  WorldConfig config = test::OpenSky();
  config.start.p_WB = config.pad_motion.p_start + Eigen::Vector3d(0.0, 0.0, 0.2);
  const auto rise = [](const WorldConfig& c) {
    World world(c);
    const double hover = world.model().HoverThrust() / 4.0;
    world.Step(Eigen::Vector4d(hover, hover, hover, hover));
    return std::pair(world.vehicle().v_WB.z() / world.timestep(), world.ground_effect_thrust());
  };
  EXPECT_NEAR(rise(config).first, 0.0, 1e-9);
  config.ground_effect = true;
  const auto [acceleration, thrust] = rise(config);
  EXPECT_GT(thrust, 0.1);
  EXPECT_NEAR(acceleration, thrust / World(config).model().mass_kg, 1e-9);
}

}  // namespace
}  // namespace touchdown::sim
