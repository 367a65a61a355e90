// SPDX-License-Identifier: BSD-3-Clause
#include "control/tracking/vehicle_frequencies.h"

#include <cmath>

#include <gtest/gtest.h>

#include "control/test/toy_world.h"

namespace touchdown::control {
namespace {

TEST(VehicleFrequencies, TheDefaultVehicleHasTheDefaults) {
  const ControllerOptions options = OptionsFor(ToyQuadrotor()), defaults;
  EXPECT_EQ(options.attitude_frequency, defaults.attitude_frequency);
  EXPECT_EQ(options.position_frequency, defaults.position_frequency);
  EXPECT_EQ(options.yaw_frequency, defaults.yaw_frequency);
  EXPECT_EQ(options.height_frequency, defaults.height_frequency);
  EXPECT_EQ(ObserverFor(ToyQuadrotor()).force_bandwidth,
            DisturbanceObserverOptions{}.force_bandwidth);
}

// With four times the inertia a loop of half the frequency needs the same moment at the same error.
TEST(VehicleFrequencies, FollowTheRootOfWhatTurnsTheVehicle) {
  estimation::VehicleModel heavy = ToyQuadrotor();
  heavy.inertia *= 4.0;
  heavy.inertia.z() *= 4.0;
  const BandwidthRatio usual = BandwidthRatioOf(heavy);
  heavy.inertia *= 4.0;
  const BandwidthRatio slow = BandwidthRatioOf(heavy);
  EXPECT_NEAR(slow.tilt, 0.5 * usual.tilt, 1e-12);
  EXPECT_NEAR(slow.yaw, 0.5 * usual.yaw, 1e-12);
  EXPECT_LT(usual.tilt, 0.51);
  EXPECT_LT(usual.yaw, 0.26);
  const ControllerOptions options = OptionsFor(heavy), defaults;
  EXPECT_NEAR(options.attitude_frequency, slow.tilt * defaults.attitude_frequency, 1e-12);
  EXPECT_EQ(options.height_frequency, defaults.height_frequency);
  EXPECT_NEAR(ObserverFor(heavy).moment_bandwidth,
              slow.tilt * DisturbanceObserverOptions{}.moment_bandwidth, 1e-12);
}

// A light vehicle with little inertia has more; it is not driven faster than the defaults.
TEST(VehicleFrequencies, AreNeverHigher) {
  estimation::VehicleModel light = ToyQuadrotor();
  light.inertia *= 0.1;
  const BandwidthRatio ratio = BandwidthRatioOf(light);
  EXPECT_EQ(ratio.tilt, 1.0);
  EXPECT_EQ(ratio.yaw, 1.0);
}

}  // namespace
}  // namespace touchdown::control
