// SPDX-License-Identifier: BSD-3-Clause
// Tests the consistency of the filter's covariance by Monte Carlo, on pads drawn from the turn-rate
// model. The sum of the normalised errors squared of n runs is then chi-squared with n times the
// state's size.
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "estimation/test/pad_drive.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/estimation/pad/pad_predictor.h"

namespace touchdown::estimation {
namespace {

struct Nees {
  double state = 0.0;      ///< mean of the state's NEES over its size
  double position = 0.0;   ///< mean of the position's NEES over 2
  double predicted = 0.0;  ///< the same, 1.5 s ahead
  int degrees = 0;         ///< of the state's sum
  int runs = 0;
};

Nees MonteCarlo(double sigma, bool tags, int runs) {
  const PadFilterOptions options;
  Nees nees;
  nees.runs = runs;
  double sum = 0.0;
  for (int run = 0; run < runs; ++run) {
    std::mt19937_64 random(1000 + static_cast<unsigned>(run));
    std::normal_distribution<double> normal;
    // Well away from standstill, where the heading is not Gaussian.
    PadVector start;
    start << normal(random), normal(random), 1.2 + 0.1 * normal(random), 3.0 * normal(random),
        0.1 * normal(random);
    const PadDrive drive(start, options.noise, 10.0, random);
    PadFilter filter(options);
    if (tags) {
      FeedGpsAndTags(filter, drive, 0.0, 6.0, sigma, random);
    } else {
      FeedGps(filter, drive, 0.0, 6.0, sigma, random);
    }
    const double t = 6.0;
    const PadBelief belief = filter.BeliefAt(t);
    PadVector truth = drive.At(t);
    if (belief.motion == PadMotion::kVelocity) {
      truth.segment<2>(2) = VelocityOf(drive.At(t));
      truth(4) = 0.0;
    }
    sum += StateNees(belief, truth);
    nees.degrees += StateSize(belief.motion);
    nees.position += PositionNees(filter.Estimate(t), drive.At(t).head<2>()) / (2.0 * runs);
    nees.predicted +=
        PositionNees(filter.Estimate(t + 1.5), drive.At(t + 1.5).head<2>()) / (2.0 * runs);
  }
  nees.state = sum / nees.degrees;
  return nees;
}

/// One of a thousand consistent filters is outside. `over` is the allowed overconfidence.
void ExpectInsideBand(double mean, int degrees, double over = 0.0) {
  const boost::math::chi_squared law(degrees);
  EXPECT_GT(mean, quantile(law, 0.0005) / degrees);
  EXPECT_LT(mean, quantile(law, 0.9995) / degrees + over);
}

class Consistency : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(PadFilter, Consistency, testing::Values(false, true),
                         [](const auto& tags) { return tags.param ? "tags" : "gps"; });

TEST_P(Consistency, NeesInsideItsBandAtGoodGps) {
  const Nees nees = MonteCarlo(0.01, GetParam(), 2000);
  RecordProperty("state", std::to_string(nees.state));
  RecordProperty("position", std::to_string(nees.position));
  RecordProperty("predicted", std::to_string(nees.predicted));
  ExpectInsideBand(nees.state, nees.degrees);
  ExpectInsideBand(nees.position, 2 * nees.runs);
  // A prediction is linear in the belief: its covariance is 4 % too small in 4800 runs.
  ExpectInsideBand(nees.predicted, 2 * nees.runs, 0.05);
}

TEST_P(Consistency, NotOverconfidentAtPoorGps) {
  for (double sigma : {0.5, 1.0}) {
    const Nees nees = MonteCarlo(sigma, GetParam(), 200);
    const boost::math::chi_squared law(2 * nees.runs);
    const double limit = quantile(law, 0.975) / (2 * nees.runs);
    RecordProperty("position_" + std::to_string(sigma), std::to_string(nees.position));
    RecordProperty("predicted_" + std::to_string(sigma), std::to_string(nees.predicted));
    EXPECT_LT(nees.position, limit) << sigma;
    EXPECT_LT(nees.predicted, limit) << sigma;
  }
}

}  // namespace
}  // namespace touchdown::estimation
