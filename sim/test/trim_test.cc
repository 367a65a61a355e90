// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/trim.h"

#include <gtest/gtest.h>

#include "sim/air/drag.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/world/world.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::sim {
namespace {

TEST(Trim, IsUprightInStillAir) {
  const estimation::VehicleModel model = LoadVehicleModel(DefaultVehicleMjcf());
  const Trim trim = TrimAt(model, Eigen::Vector3d::Zero(), 0.7).value();
  EXPECT_NEAR(estimation::Tilt(trim.q_WB), 0.0, 1e-9);
  EXPECT_NEAR(estimation::Yaw(trim.q_WB), 0.7, 1e-12);
  EXPECT_DOUBLE_EQ(trim.thrust, model.HoverThrust());
}

TEST(Trim, BalancesQuadraticDrag) {
  estimation::VehicleModel model = LoadVehicleModel(DefaultVehicleMjcf());
  model.rotor_drag.setZero();
  model.body_drag_area = 0.05;
  const double drag = 0.5 * 1.225 * model.body_drag_area * 100.0;
  const Eigen::Vector3d axis =
      TrimAt(model, {10.0, 0.0, 0.0}, 0.0).value().q_WB * Eigen::Vector3d::UnitZ();
  // Flying forward at 10 m/s the thrust leans forward by drag over weight.
  EXPECT_NEAR(axis.x() / axis.z(), drag / model.HoverThrust(), 1e-9);
}

TEST(Trim, BalancesAllForcesAtEveryYaw) {
  WorldConfig config;
  config.start.p_WB.z() = 20.0;
  const estimation::VehicleModel model = World(config).model();
  const Eigen::Vector3d u_W(9.0, -6.0, 0.5);
  for (const double yaw : {-3.0, -1.0, 0.0, 0.4, 2.0}) {
    const Trim trim = TrimAt(model, u_W, yaw).value();
    const Eigen::Matrix3d R_WB = trim.q_WB.toRotationMatrix();
    const Eigen::Vector3d sum = trim.thrust * R_WB.col(2) + DragForce(model, R_WB, u_W) -
                                model.HoverThrust() * Eigen::Vector3d::UnitZ();
    EXPECT_LT(sum.norm(), 1e-8 * model.HoverThrust());
    EXPECT_NEAR(estimation::Yaw(trim.q_WB), yaw, 1e-12);
  }
}

TEST(Trim, IsNothingWhereTheRotorsCannotHoldTheVehicle) {
  WorldConfig config;
  config.start.p_WB = {0.0, 0.0, 20.0};
  estimation::VehicleModel model = World(config).model();
  EXPECT_FALSE(TrimAt(model, {0.0, 0.0, -90.0}, 0.0)) << "air that lifts it away";
  EXPECT_FALSE(TrimAt(model, {90.0, 0.0, 0.0}, 0.0)) << "more drag than thrust";
  model.rotor_drag << 10.0, 10.0, 0.0;
  EXPECT_FALSE(TrimAt(model, {15.0, 0.0, 0.0}, 0.0)) << "no fixed point is near";
  config.hover_air_W = {90.0, 0.0, 0.0};
  EXPECT_LT(estimation::Tilt(World(config).vehicle().q_WB), 1e-9);
}

// With the commands of the start, the vehicle stays where it is: this is the purpose of the trim.
TEST(Trim, AWorldThatComesOutOfAHoverStaysInIt) {
  WorldConfig config;
  config.start.p_WB = {0.0, 0.0, 20.0};
  config.plant.mass = 0.8;
  config.plant.thrust = 1.2;
  config.plant.drag = 1.2;
  config.hover_air_W = {9.0, 9.0, 1.0};
  World world(config);
  const auto commands = world.rotor_commands();
  for (int step = 0; step < 100; ++step) world.Step(commands, *config.hover_air_W);
  EXPECT_LT((world.vehicle().p_WB - config.start.p_WB).norm(), 1e-3);
  EXPECT_GT(estimation::Tilt(world.vehicle().q_WB), 0.1);
}

}  // namespace
}  // namespace touchdown::sim
