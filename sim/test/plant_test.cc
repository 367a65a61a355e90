// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that differs from the model of its onboard software, in the world.
#include "touchdown/sim/vehicle/plant.h"

#include <array>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"
#include "sim/world/world.h"

namespace touchdown::sim {
namespace {

World Altered(const std::function<void(PlantFactors*)>& alter) {
  WorldConfig config = test::OpenSky();
  alter(&config.plant);
  return World(config);
}

Eigen::Vector4d All(double thrust) { return Eigen::Vector4d::Constant(thrust); }

TEST(Plant, PilotsModelStaysWhatItWas) {
  const World usual(test::OpenSky());
  const World heavy = Altered([](PlantFactors* f) { f->mass = 1.2; });
  EXPECT_EQ(heavy.model().mass_kg, usual.model().mass_kg);
  EXPECT_NEAR(heavy.plant().mass_kg, 1.2 * usual.model().mass_kg, 1e-12);
}

TEST(Plant, HoversAtTheThrustThatItNeeds) {
  // Heavier, and its rotors give less than they are told.
  World world = Altered([](PlantFactors* f) {
    f->mass = 1.2;
    f->thrust = 0.9;
  });
  const double told = 1.2 / 0.9 * world.model().HoverThrust() / 4.0;
  for (int i = 0; i < 500; ++i) world.Step(All(told));
  EXPECT_LT((world.vehicle().p_WB - Eigen::Vector3d(0.0, 0.0, 5.0)).norm(), 1e-9);
  EXPECT_NEAR(world.rotor_thrusts()[0], world.plant().HoverThrust() / 4.0, 1e-12);
}

TEST(Plant, MassFallsShort) {
  World world = Altered([](PlantFactors* f) { f->mass = 1.25; });
  for (int i = 0; i < 500; ++i) world.Step(All(world.model().HoverThrust() / 4.0));
  const double before = world.vehicle().v_WB.z();
  world.Step(All(world.model().HoverThrust() / 4.0));
  const double acceleration = (world.vehicle().v_WB.z() - before) / world.timestep();
  const double expected =
      (world.model().HoverThrust() + world.drag_force().z()) / world.plant().mass_kg -
      estimation::kGravity;
  EXPECT_NEAR(acceleration, expected, 1e-3);
}

TEST(Plant, InertiaDividesTheAngularAcceleration) {
  const auto rolled = [](double factor) {
    World world = Altered([&](PlantFactors* f) { f->inertia = factor; });
    const double hover = world.model().HoverThrust() / 4.0;
    for (int i = 0; i < 10; ++i)
      world.Step(Eigen::Vector4d(hover + 0.1, hover + 0.1, hover - 0.1, hover - 0.1));
    return world.vehicle().w_WB_B.x();
  };
  EXPECT_NEAR(rolled(1.0) / rolled(1.2), 1.2, 1e-3);
  EXPECT_NEAR(rolled(1.0) / rolled(0.8), 0.8, 1e-3);
}

TEST(Plant, RotorsLagLonger) {
  World world = Altered([](PlantFactors* f) { f->rotor_lag = 1.5; });
  const double from = world.rotor_thrusts()[0];
  while (world.time() < 1.5 * world.model().rotor_lag_s - 0.5 * world.timestep()) {
    world.Step(All(6.0));
  }
  // The simulator's own Euler steps make it a little quicker.
  EXPECT_NEAR((world.rotor_thrusts()[0] - from) / (6.0 - from), 1.0 - std::exp(-1.0), 0.01);
}

TEST(Plant, DragGrows) {
  World usual(test::OpenSky());
  World draggy = Altered([](PlantFactors* f) { f->drag = 2.0; });
  const Eigen::Vector3d wind(9.0, 0.0, 0.0);
  usual.Step(All(2.9), wind);
  draggy.Step(All(2.9), wind);
  EXPECT_NEAR(draggy.drag_force().x(), 2.0 * usual.drag_force().x(), 1e-12);
}

TEST(Plant, RefusesWhatCannotFly) {
  EXPECT_THAT(test::MessageOf<std::invalid_argument>(
                  [] { Altered([](PlantFactors* f) { f->thrust = 0.2; }); }),
              testing::HasSubstr("plant.thrust is 0.2; allowed is [0.5, 2]"));
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([] {
                Altered([](PlantFactors* f) {
                  f->mass = 1.9;
                  f->thrust = 0.6;
                });
              }),
              testing::HasSubstr("more thrust"));
}

}  // namespace
}  // namespace touchdown::sim
