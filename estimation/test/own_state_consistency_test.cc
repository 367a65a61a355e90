// SPDX-License-Identifier: BSD-3-Clause
// Tests the consistency of OwnStateFilter's covariance by Monte Carlo, on flights with
// accelerations and turns. Every error is drawn from the filter's own model. The sum of the
// normalised errors squared of n runs is then chi-squared with n times the state's size.
#include <string>

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "estimation/test/own_flight.h"

namespace touchdown::estimation {
namespace {

constexpr int kRuns = 100;

void ExpectInsideBand(double sum, int degrees, const std::string& what) {
  const boost::math::chi_squared law(degrees);
  testing::Test::RecordProperty(what, std::to_string(sum / degrees));
  EXPECT_GT(sum, quantile(law, 0.025)) << what << " " << sum / degrees;
  EXPECT_LT(sum, quantile(law, 0.975)) << what << " " << sum / degrees;
}

OwnRig RigOf(const std::string& sensors) {
  OwnRig rig;
  if (sensors == "late_gps") rig.delay = 20;
  if (sensors == "odometry") {
    rig.position_every = 0;
    rig.velocity_every = 8;
  }
  return rig;
}

class OwnConsistency : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(OwnStateFilter, OwnConsistency,
                         testing::Values("gps", "late_gps", "odometry"),
                         [](const auto& sensors) { return sensors.param; });

TEST_P(OwnConsistency, NeesInsideItsBand) {
  const double times[] = {2.0, 10.0};
  double state[2] = {};
  double position[2] = {};
  double velocity[2] = {};
  double attitude[2] = {};
  for (unsigned run = 0; run < kRuns; ++run) {
    OwnRun flight(5000 + run, 1.0, RigOf(GetParam()));
    flight.StartFromPrior();
    for (int k = 0; k < 2; ++k) {
      flight.FlyTo(times[k]);
      state[k] += flight.Nees(0, kOwnErrors);
      position[k] += flight.Nees(kPositionError, 3);
      velocity[k] += flight.Nees(kVelocityError, 3);
      attitude[k] += flight.Nees(kAttitudeError, 3);
    }
  }
  for (int k = 0; k < 2; ++k) {
    const std::string at = k == 0 ? "_2s" : "_10s";
    ExpectInsideBand(state[k], kOwnErrors * kRuns, "state" + at);
    ExpectInsideBand(position[k], 3 * kRuns, "position" + at);
    ExpectInsideBand(velocity[k], 3 * kRuns, "velocity" + at);
    ExpectInsideBand(attitude[k], 3 * kRuns, "attitude" + at);
  }
}

// From a hover the start is found, not drawn: tilt comes from the force, so its error follows the
// bias.
TEST(OwnStateFilter, StartFromAHoverIsConsistent) {
  double tilt_and_bias = 0.0;
  double state = 0.0;
  OwnRig rig;
  for (unsigned run = 0; run < kRuns; ++run) {
    OwnRun flight(9000 + run, 0.0, rig);
    flight.FlyTo(3.0);
    ASSERT_TRUE(flight.filter.started());
    tilt_and_bias += flight.Nees(kAttitudeError, 6);
    state += flight.Nees(0, kOwnErrors);
  }
  // The hover of this test is motionless, the filter allows for some motion: below one is right.
  const boost::math::chi_squared law(kOwnErrors * kRuns);
  const boost::math::chi_squared part(6 * kRuns);
  testing::Test::RecordProperty("state", std::to_string(state / (kOwnErrors * kRuns)));
  testing::Test::RecordProperty("tilt_and_bias", std::to_string(tilt_and_bias / (6 * kRuns)));
  EXPECT_LT(state, quantile(law, 0.975));
  EXPECT_LT(tilt_and_bias, quantile(part, 0.975));
  EXPECT_GT(state, 0.5 * kOwnErrors * kRuns);
}

}  // namespace
}  // namespace touchdown::estimation
