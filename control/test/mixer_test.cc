// SPDX-License-Identifier: BSD-3-Clause
#include "control/tracking/mixer.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "control/test/flight_model.h"

namespace touchdown::control {
namespace {

/// Uneven arms and a shifted centre of mass: nothing about the mixer may need symmetry.
estimation::VehicleModel UnevenVehicle() {
  estimation::VehicleModel model = TestVehicle();
  model.actuators[0].p_BR << 0.20, -0.12, 0.0;
  model.actuators[1].p_BR << -0.15, 0.14, 0.0;
  model.actuators[2].p_BR << 0.16, 0.17, 0.0;
  model.actuators[3].p_BR << -0.14, -0.16, 0.0;
  for (estimation::Actuator& rotor : model.actuators) rotor.min = 0.1;
  return model;
}

/// Rotors all around, 0.2 m from the middle, those beside each other in opposite senses.
estimation::VehicleModel Around(int rotors) {
  estimation::VehicleModel model;
  for (int i = 0; i < rotors; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / rotors;
    model.actuators.push_back(
        estimation::RotorAt({0.2 * std::cos(angle), 0.2 * std::sin(angle), 0.0},
                            i % 2 == 0 ? 0.016 : -0.016, 28.0 / rotors));
  }
  return model;
}

/// One thrust, x [m] ahead of the centre of mass, and three moments, one of them about the axis turned round.
estimation::VehicleModel WrenchVehicle(double x = 0.0) {
  estimation::VehicleModel model;
  model.actuators = {{x * Eigen::Vector3d::UnitX(), 1.0, Eigen::Vector3d::Zero(), 0.0, 28.0},
                     {Eigen::Vector3d::Zero(), 0.0, -Eigen::Vector3d::UnitX(), -2.0, 2.0},
                     {Eigen::Vector3d::Zero(), 0.0, Eigen::Vector3d::UnitY(), -2.0, 2.0},
                     {Eigen::Vector3d::Zero(), 0.0, Eigen::Vector3d::UnitZ(), -0.3, 0.3}};
  return model;
}

estimation::Commands Unlimited(const estimation::VehicleModel& model, const Wrench& wrench) {
  Eigen::Vector4d w;
  w << wrench.thrust, wrench.moment_B;
  return estimation::AllocationOf(model).commands_of_wrench * w;
}

Wrench Difference(const Wrench& a, const Wrench& b) {
  return {a.thrust - b.thrust, a.moment_B - b.moment_B};
}

TEST(Mixer, PaperPlusConfiguration) {
  // Eq. 8: rotors on the axes, L = 0.2 m, tau/k = 0.016 m.
  estimation::VehicleModel model;
  model.actuators = {estimation::RotorAt({0.2, 0.0, 0.0}, 0.016, 7.0),
                     estimation::RotorAt({0.0, 0.2, 0.0}, -0.016, 7.0),
                     estimation::RotorAt({-0.2, 0.0, 0.0}, 0.016, 7.0),
                     estimation::RotorAt({0.0, -0.2, 0.0}, -0.016, 7.0)};
  const Wrench wrench = Mixer(model).Apply(Eigen::Vector4d(1.0, 2.0, 3.0, 5.0));
  EXPECT_DOUBLE_EQ(wrench.thrust, 11.0);
  EXPECT_DOUBLE_EQ(wrench.moment_B.x(), 0.2 * (2.0 - 5.0));
  EXPECT_DOUBLE_EQ(wrench.moment_B.y(), 0.2 * (3.0 - 1.0));
  EXPECT_DOUBLE_EQ(wrench.moment_B.z(), 0.016 * (1.0 - 2.0 + 3.0 - 5.0));
}

TEST(Mixer, UnsaturatedRoundTripIsExact) {
  std::mt19937_64 random(1);
  for (const auto& model : {TestVehicle(), UnevenVehicle()}) {
    const Mixer mixer(model);
    const estimation::Actuator& rotor = model.actuators[0];
    std::uniform_real_distribution<double> thrust(rotor.min, rotor.max);
    for (int trial = 0; trial < 1000; ++trial) {
      Eigen::Vector4d thrusts;
      for (int i = 0; i < 4; ++i) thrusts(i) = thrust(random);
      const MixerOutput output = mixer.Mix(mixer.Apply(thrusts));
      EXPECT_LT((output.thrusts - thrusts).norm(), 1e-9);
    }
  }
}

// With more than four rotors many commands make a wrench: the shortest is taken.
TEST(Mixer, MoreRotorsMakeTheSameWrenchWithTheLeastSquares) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const auto& model : {Around(6), Around(8), WrenchVehicle()}) {
    const Mixer mixer(model);
    for (int trial = 0; trial < 1000; ++trial) {
      const Wrench wrench = {
          12.0 + uniform(random),
          {0.3 * uniform(random), 0.3 * uniform(random), 0.03 * uniform(random)}};
      const MixerOutput output = mixer.Mix(wrench);
      ASSERT_FALSE(output.saturated);
      const Wrench error = Difference(mixer.Apply(output.thrusts), wrench);
      EXPECT_LT(error.moment_B.norm() + std::abs(error.thrust), 1e-9);
      // Any other commands of the same wrench are longer.
      estimation::Commands aside(output.thrusts.size());
      for (double& command : aside) command = uniform(random);
      const Wrench made = mixer.Apply(aside);
      aside -= Unlimited(model, made);
      if (aside.norm() < 1e-9) continue;
      EXPECT_LT(std::abs(output.thrusts.dot(aside)), 1e-9);
    }
  }
}

// A thrust beside the centre of mass needs a moment for each newton, whichever side it is on.
TEST(Mixer, MomentsMayShareInTheThrust) {
  for (const double x : {-0.01, 0.01}) {
    EXPECT_NEAR(estimation::AllocationOf(WrenchVehicle(x)).thrust_max, 28.0, 1e-12);
  }
}

// A wheel with little yaw moment, in any unit, takes nothing from the rotors.
TEST(Mixer, OneMoreActuatorTakesNoAuthorityAway) {
  const double alone = estimation::HoverTurn(TestVehicle()).z();
  for (const double most : {0.001, 0.1, 1.0}) {
    estimation::VehicleModel model = TestVehicle();
    model.actuators.push_back(
        {Eigen::Vector3d::Zero(), 0.0, Eigen::Vector3d::UnitZ(), -most, most});
    EXPECT_GE(estimation::HoverTurn(model).z(), alone * (1.0 - 1e-9)) << most;
  }
}

TEST(Mixer, SaturatedKeepsLimitsAndPriority) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int saturated = 0;
  for (const auto& model : {TestVehicle(), UnevenVehicle(), Around(6), Around(8), WrenchVehicle(),
                            WrenchVehicle(-0.01), WrenchVehicle(0.01)}) {
    const Mixer mixer(model);
    for (int trial = 0; trial < 5000; ++trial) {
      Wrench wrench;
      wrench.thrust = 15.0 + 25.0 * uniform(random);
      wrench.moment_B << 4.0 * uniform(random), 4.0 * uniform(random), 0.6 * uniform(random);
      const MixerOutput output = mixer.Mix(wrench);
      ASSERT_TRUE((output.thrusts.array() >= mixer.min().array()).all());
      ASSERT_TRUE((output.thrusts.array() <= mixer.max().array()).all());
      const Wrench error = Difference(mixer.Apply(output.thrusts), wrench);
      if (!output.saturated) {
        ASSERT_LT(error.moment_B.norm() + std::abs(error.thrust), 1e-9);
        continue;
      }
      ++saturated;
      // Roll and pitch: kept, or scaled down together.
      const Eigen::Vector2d got = mixer.Apply(output.thrusts).moment_B.head<2>();
      const Eigen::Vector2d wanted = wrench.moment_B.head<2>();
      const double scale = got.dot(wanted) / wanted.squaredNorm();
      ASSERT_LE(scale, 1.0 + 1e-9);
      ASSERT_GT(scale, 0.0);
      ASSERT_LT((got - scale * wanted).norm(), 1e-9);
      const bool tilt_kept = scale > 1.0 - 1e-9;
      // Yaw never reverses and never grows.
      const double yaw = mixer.Apply(output.thrusts).moment_B.z();
      ASSERT_GE(yaw * wrench.moment_B.z(), -1e-9);
      ASSERT_LE(std::abs(yaw), std::abs(wrench.moment_B.z()) + 1e-9);
      // Thrust gives way only if roll and pitch alone leave no room for it.
      Wrench without_yaw = wrench;
      without_yaw.moment_B.z() = 0.0;
      if (!mixer.Mix(without_yaw).saturated) {
        ASSERT_TRUE(tilt_kept);
        ASSERT_LT(std::abs(error.thrust), 1e-9);
      }
    }
  }
  EXPECT_GT(saturated, 7500);
}

// Before, a turn lifted a vehicle with stronger rotors than modelled by metres per second.
TEST(Mixer, RollAndPitchRaiseTheThrustToHalfOfHoverAtMost) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const double least : {0.0, 0.1, 1.0, 2.0}) {  // N, of 2.9 in hover
    estimation::VehicleModel model = TestVehicle();
    for (estimation::Actuator& rotor : model.actuators) rotor.min = least;
    const Mixer mixer(model);
    const double raised = 4.0 * least + Mixer::kRaisedThrust * (model.HoverThrust() - 4.0 * least);
    for (int trial = 0; trial < 1000; ++trial) {
      const Wrench wrench = {model.HoverThrust() * (1.0 + uniform(random)),
                             {4.0 * uniform(random), 4.0 * uniform(random), 0.0}};
      const Wrench got = mixer.Apply(mixer.Mix(wrench).thrusts);
      EXPECT_LE(got.thrust, std::max(wrench.thrust, raised) + 1e-9);
      EXPECT_GT(got.moment_B.head<2>().norm(), 0.01);  // some authority is always left
    }
  }
}

TEST(Mixer, BrokenWrenchGivesLeastThrust) {
  const Mixer mixer(UnevenVehicle());
  Wrench wrench;
  wrench.moment_B.y() = std::numeric_limits<double>::quiet_NaN();
  const MixerOutput output = mixer.Mix(wrench);
  EXPECT_TRUE(output.saturated);
  EXPECT_EQ(output.thrusts, Eigen::Vector4d::Constant(0.1));
}

TEST(Mixer, ImpossibleGeometryIsRefused) {
  estimation::VehicleModel same_place;
  EXPECT_THROW(Mixer{same_place}, std::invalid_argument);
  estimation::VehicleModel outside = TestVehicle();
  for (auto& rotor : outside.actuators) rotor.p_BR.x() += 0.5;
  EXPECT_THROW(Mixer{outside}, std::invalid_argument);
  estimation::VehicleModel limits = TestVehicle();
  limits.actuators[2].max = 0.0;
  EXPECT_THROW(Mixer{limits}, std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::control
