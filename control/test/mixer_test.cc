// SPDX-License-Identifier: BSD-3-Clause
#include "control/tracking/mixer.h"

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "control/test/flight_model.h"

namespace touchdown::control {
namespace {

/// Uneven arms and a shifted centre of mass: nothing about the mixer may need symmetry.
estimation::VehicleModel UnevenVehicle() {
  estimation::VehicleModel model = TestVehicle();
  model.rotors[0].p_BR << 0.20, -0.12, 0.0;
  model.rotors[1].p_BR << -0.15, 0.14, 0.0;
  model.rotors[2].p_BR << 0.16, 0.17, 0.0;
  model.rotors[3].p_BR << -0.14, -0.16, 0.0;
  model.rotor_thrust_min = 0.1;
  return model;
}

Wrench Difference(const Wrench& a, const Wrench& b) {
  return {a.thrust - b.thrust, a.moment_B - b.moment_B};
}

TEST(Mixer, PaperPlusConfiguration) {
  // Eq. 8: rotors on the axes, L = 0.2 m, tau/k = 0.016 m.
  estimation::VehicleModel model;
  model.rotors[0] = {Eigen::Vector3d(0.2, 0.0, 0.0), 1.0};
  model.rotors[1] = {Eigen::Vector3d(0.0, 0.2, 0.0), -1.0};
  model.rotors[2] = {Eigen::Vector3d(-0.2, 0.0, 0.0), 1.0};
  model.rotors[3] = {Eigen::Vector3d(0.0, -0.2, 0.0), -1.0};
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
    std::uniform_real_distribution<double> thrust(model.rotor_thrust_min, model.rotor_thrust_max);
    for (int trial = 0; trial < 1000; ++trial) {
      Eigen::Vector4d thrusts;
      for (int i = 0; i < 4; ++i) thrusts(i) = thrust(random);
      const MixerOutput output = mixer.Mix(mixer.Apply(thrusts));
      EXPECT_LT((output.thrusts - thrusts).norm(), 1e-9);
    }
  }
}

TEST(Mixer, SaturatedKeepsLimitsAndPriority) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int saturated = 0;
  for (const auto& model : {TestVehicle(), UnevenVehicle()}) {
    const Mixer mixer(model);
    for (int trial = 0; trial < 5000; ++trial) {
      Wrench wrench;
      wrench.thrust = 15.0 + 25.0 * uniform(random);
      wrench.moment_B << 4.0 * uniform(random), 4.0 * uniform(random), 0.6 * uniform(random);
      const MixerOutput output = mixer.Mix(wrench);
      ASSERT_GE(output.thrusts.minCoeff(), model.rotor_thrust_min);
      ASSERT_LE(output.thrusts.maxCoeff(), model.rotor_thrust_max);
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
  EXPECT_GT(saturated, 3000);
}

// Before, a turn lifted a vehicle whose rotors are stronger than it knows by metres per second.
TEST(Mixer, RollAndPitchRaiseTheThrustToHalfOfHoverAtMost) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const double least : {0.0, 0.1, 1.0, 2.0}) {  // N, of 2.9 in hover
    estimation::VehicleModel model = TestVehicle();
    model.rotor_thrust_min = least;
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
  for (auto& rotor : outside.rotors) rotor.p_BR.x() += 0.5;
  EXPECT_THROW(Mixer{outside}, std::invalid_argument);
  estimation::VehicleModel limits = TestVehicle();
  limits.rotor_thrust_max = 0.0;
  EXPECT_THROW(Mixer{limits}, std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::control
