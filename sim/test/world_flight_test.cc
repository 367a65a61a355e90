// SPDX-License-Identifier: BSD-3-Clause
// The vehicle in free air, and the pad's drive.
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/air/drag.h"
#include "sim/test/scenes.h"
#include "sim/world/world.h"

namespace touchdown::sim {
namespace {

using Thrusts = Eigen::Vector4d;
using Kind = PadMotionConfig::Kind;

Thrusts All(double thrust) { return Thrusts::Constant(thrust); }

double Hover(const World& world) { return world.model().HoverThrust() / 4.0; }

TEST(WorldFlight, HoverThrustHolds) {
  World world(test::OpenSky());
  for (int i = 0; i < 5000; ++i) world.Step(All(Hover(world)));
  EXPECT_NEAR(world.time(), 10.0, 1e-12);
  EXPECT_EQ(world.vehicle().t, world.time());
  EXPECT_LT((world.vehicle().p_WB - Eigen::Vector3d(0, 0, 5)).norm(), 1e-9);
  EXPECT_NEAR(world.vehicle().q_WB.w(), 1.0, 1e-12);
  EXPECT_TRUE(world.contacts().empty());
  EXPECT_EQ(world.foot_force().force, 0.0);
}

TEST(WorldFlight, FreeFallWithoutThrustAndDrag) {
  WorldConfig config = test::OpenSky();
  config.start.p_WB.z() = 20.0;
  World world(config);
  for (int i = 0; i < 250; ++i) world.Step(All(0.0));
  const double fallen_from = world.vehicle().p_WB.z();
  const double speed = world.vehicle().v_WB.z();
  const double drag_before = world.drag_force().z();
  for (int i = 0; i < 50; ++i) world.Step(All(0.0));
  // Half a second after cut-off the rotors give nothing; drag at 5 m/s takes 0.5 N of the
  // weight, 11.6 N.
  const double drag = 0.5 * (drag_before + world.drag_force().z()) / world.model().mass_kg;
  EXPECT_NEAR((world.vehicle().v_WB.z() - speed) / 0.1, -estimation::kGravity + drag, 0.01);
  EXPECT_NEAR(world.vehicle().p_WB.z() - fallen_from,
              0.5 * (speed + world.vehicle().v_WB.z()) * 0.1, 2e-3);
}

TEST(WorldFlight, RotorsLagByTheirTimeConstant) {
  World world(test::OpenSky());
  const double from = Hover(world);
  const double to = 6.0;
  const double lag = world.model().rotor_lag_s;
  double time_at_63_percent = 0.0;
  while (world.time() < 0.5) {
    world.Step(All(to));
    const double expected = to + (from - to) * std::exp(-world.time() / lag);
    ASSERT_NEAR(world.rotor_thrusts()[2], expected, 0.04 * (to - from));
    if (time_at_63_percent == 0.0 &&
        world.rotor_thrusts()[2] > from + (1.0 - std::exp(-1.0)) * (to - from)) {
      time_at_63_percent = world.time();
    }
  }
  EXPECT_NEAR(time_at_63_percent, lag, world.timestep());
  EXPECT_NEAR(world.rotor_thrusts()[2], to, 1e-5);
}

TEST(WorldFlight, CommandsAreClippedToTheLimits) {
  World world(test::OpenSky());
  for (int i = 0; i < 300; ++i) world.Step(Thrusts(20.0, -5.0, 20.0, -5.0));
  EXPECT_NEAR(world.rotor_thrusts()[0], world.model().actuators[0].max, 1e-6);
  EXPECT_NEAR(world.rotor_thrusts()[1], 0.0, 1e-6);
}

// Angular acceleration in B right after a constant difference of thrusts has built up.
Eigen::Vector3d AngularAcceleration(const Thrusts& difference) {
  World world(test::OpenSky());
  Thrusts commands = All(Hover(world));
  commands += difference;
  world.Step(commands);
  const Eigen::Vector3d before = world.vehicle().w_WB_B;
  const Thrusts thrusts = world.rotor_thrusts();
  world.Step(commands);
  const Eigen::Vector3d measured = (world.vehicle().w_WB_B - before) / world.timestep();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    const estimation::Actuator& rotor = world.model().actuators[static_cast<std::size_t>(i)];
    torque += rotor.p_BR.cross(thrusts[i] * Eigen::Vector3d::UnitZ());
    torque += rotor.moment_B * thrusts[i];
  }
  EXPECT_LT((measured - torque.cwiseQuotient(world.model().inertia)).norm(),
            1e-6 + 1e-3 * measured.norm());
  return measured;
}

TEST(WorldFlight, TorquesHaveSignAndSize) {
  // Rotors 0 and 2 spin +: more of them turns the vehicle to the left.
  const Eigen::Vector3d yaw = AngularAcceleration(Thrusts{0.5, -0.5, 0.5, -0.5});
  EXPECT_GT(yaw.z(), 0.0);
  EXPECT_LT(yaw.head<2>().norm(), 1e-9);
  // More thrust on the left (0, 1) rolls to the right: positive about x.
  const Eigen::Vector3d roll = AngularAcceleration(Thrusts{0.2, 0.2, -0.2, -0.2});
  EXPECT_GT(roll.x(), 0.0);
  EXPECT_LT(std::abs(roll.y()) + std::abs(roll.z()), 1e-9);
  // More thrust behind (1, 2) lowers the nose: positive about y.
  const Eigen::Vector3d pitch = AngularAcceleration(Thrusts{-0.2, 0.2, 0.2, -0.2});
  EXPECT_GT(pitch.y(), 0.0);
  EXPECT_LT(std::abs(pitch.x()) + std::abs(pitch.z()), 1e-9);
}

TEST(WorldFlight, ThrustIsAlongTheBodysAxisAndRatesAreInTheBody) {
  WorldConfig config = test::OpenSky();
  const Eigen::Quaterniond q(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()));
  config.start.q_WB = q;
  config.start.w_WB_B = {0.0, 0.0, 2.0};  // a steady spin about the thrust axis
  World world(config);
  const double thrust = world.model().HoverThrust();
  world.Step(All(Hover(world)));
  const Eigen::Vector3d acceleration = world.vehicle().v_WB / world.timestep();
  const Eigen::Vector3d expected = q * Eigen::Vector3d(0, 0, thrust / world.model().mass_kg) -
                                   Eigen::Vector3d(0, 0, estimation::kGravity);
  EXPECT_LT((acceleration - expected).norm(), 1e-9);
  EXPECT_LT((world.vehicle().w_WB_B - config.start.w_WB_B).norm(), 1e-9);
  for (int i = 0; i < 99; ++i) world.Step(All(Hover(world)));
  EXPECT_LT((world.vehicle().w_WB_B - config.start.w_WB_B).norm(), 1e-9);
  const Eigen::Quaterniond spun =
      q * Eigen::Quaterniond(Eigen::AngleAxisd(2.0 * world.time(), Eigen::Vector3d::UnitZ()));
  EXPECT_LT(world.vehicle().q_WB.angularDistance(spun), 1e-6);
}

TEST(WorldFlight, WindPushesWithTheDragModel) {
  WorldConfig config = test::OpenSky();
  config.start.v_WB = {1.0, -2.0, 0.5};
  World world(config);
  const Eigen::Vector3d wind(8.0, 3.0, -1.0);
  const Eigen::Vector3d expected =
      DragForce(world.model(), Eigen::Matrix3d::Identity(), config.start.v_WB - wind);
  world.Step(All(Hover(world)), wind);
  EXPECT_LT((world.drag_force() - expected).norm(), 1e-12);
  const Eigen::Vector3d gained = (world.vehicle().v_WB - config.start.v_WB) / world.timestep();
  EXPECT_LT((world.model().mass_kg * gained - expected).norm(), 1e-9);
  EXPECT_LT(world.vehicle().w_WB_B.norm(), 1e-12);  // acts at the centre of mass
}

TEST(WorldFlight, PadLagsItsMotionByNoMoreThanStated) {
  for (const double speed : {0.8, 10.0}) {
    for (const Kind kind : {Kind::kStatic, Kind::kCircle, Kind::kStraightTurn, Kind::kFigureEight,
                            Kind::kStopAndGo, Kind::kReversing, Kind::kRandom}) {
      WorldConfig config = test::OpenSky();
      config.pad_motion.kind = kind;
      config.pad_motion.speed = kind == Kind::kStatic ? 0.0 : speed;
      config.pad_motion.acceleration = 0.4 * speed + 0.2;
      config.pad_motion.go_time = config.pad_motion.stop_time = 12.0;
      World world(config);
      const World::PadLag most = world.MaxPadLag();
      World::PadLag worst;
      while (world.time() < 30.0) {
        world.Step(All(Hover(world)));
        const estimation::PadState truth = world.pad();
        const estimation::PadState path = world.pad_course()->At(world.time());
        worst.position = std::max(worst.position, (truth.p_WP - path.p_WP).norm());
        worst.velocity = std::max(worst.velocity, (truth.v_WP - path.v_WP).norm());
        worst.yaw = std::max(worst.yaw, std::abs(truth.yaw - path.yaw));
        worst.yaw_rate = std::max(worst.yaw_rate, std::abs(truth.yaw_rate - path.yaw_rate));
      }
      EXPECT_LE(worst.position, most.position) << speed << " " << static_cast<int>(kind);
      EXPECT_LE(worst.velocity, most.velocity) << speed << " " << static_cast<int>(kind);
      EXPECT_LE(worst.yaw, most.yaw) << speed << " " << static_cast<int>(kind);
      EXPECT_LE(worst.yaw_rate, most.yaw_rate) << speed << " " << static_cast<int>(kind);
      // There is a lag to be stated: the turn builds up at 0.3 rad/s^2.
      if (kind == Kind::kStraightTurn && speed == 0.8) {
        EXPECT_GT(worst.yaw_rate, 0.001);
      }
    }
  }
}

TEST(WorldFlight, PadFollowsItsPath) {
  for (const Kind kind : {Kind::kStatic, Kind::kLine, Kind::kCircle, Kind::kStraightTurn,
                          Kind::kFigureEight, Kind::kStopAndGo, Kind::kReversing, Kind::kRandom}) {
    WorldConfig config = test::OpenSky();
    config.pad_motion.kind = kind;
    config.pad_motion.heading = 1.0;
    config.pad_motion.phase = 1.5;
    World world(config);
    EXPECT_LT((world.pad().p_WP - world.pad_course()->At(0.0).p_WP).norm(), 1e-12);
    double worst = 0.0;
    double worst_yaw = 0.0;
    double worst_speed = 0.0;
    while (world.time() < 30.0) {
      world.Step(All(Hover(world)));
      const estimation::PadState truth = world.pad();
      const estimation::PadState path = world.pad_course()->At(world.time());
      worst = std::max(worst, (truth.p_WP - path.p_WP).norm());
      worst_speed = std::max(worst_speed, (truth.v_WP - path.v_WP).norm());
      worst_yaw = std::max(worst_yaw, std::abs(truth.yaw - path.yaw));
    }
    EXPECT_LT(worst, 0.003);
    EXPECT_LT(worst_speed, 0.005);
    EXPECT_LT(worst_yaw, 0.003);
  }
}

TEST(WorldFlight, VelocityOverTheDeckKnowsItsTurning) {
  WorldConfig config = test::OpenSky();
  config.pad_motion.kind = Kind::kCircle;
  const estimation::PadState pad = PadMotion(config.pad_motion).At(0.0);
  const Eigen::Vector3d arm(0.5, -0.3, 2.0);
  config.start.p_WB = pad.p_WP + arm;
  config.start.v_WB = pad.v_WP + Eigen::Vector3d(0.0, 0.0, pad.yaw_rate).cross(arm) +
                      Eigen::Vector3d(0.1, 0.2, -0.3);
  const World world(config);
  EXPECT_LT((world.velocity_over_deck() - Eigen::Vector3d(0.1, 0.2, -0.3)).norm(), 1e-12);
}

TEST(WorldFlight, RefusesCommandsThatAreNoNumbers) {
  World world(test::OpenSky());
  EXPECT_THAT(test::MessageOf<std::invalid_argument>(
                  [&] { world.Step(Eigen::Vector4d(1.0, std::nan(""), 1.0, 1.0)); }),
              ::testing::HasSubstr("rotor 1 [N] is nan"));
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([&] {
                world.Step(All(1.0), {200.0, 0.0, 0.0});
              }),
              ::testing::HasSubstr("wind speed [m/s] is 200; allowed is [0, 100]"));
  world.Step(All(1.0));  // a refused step changes nothing
  EXPECT_EQ(world.time(), world.timestep());
}

TEST(WorldFlight, FailedPhysicsIsASentenceAndStaysFailed) {
  WorldConfig config = test::OpenSky();
  config.start.v_WB = {1e12, 0.0, 0.0};
  World world(config);
  EXPECT_THAT(test::MessageOf<std::runtime_error>([&] { world.Step(All(1.0)); }),
              ::testing::HasSubstr("the simulation failed at t = 0 s"));
  EXPECT_THAT(test::MessageOf<std::runtime_error>([&] { world.Step(All(1.0)); }),
              ::testing::HasSubstr("earlier step"));
}

}  // namespace
}  // namespace touchdown::sim
