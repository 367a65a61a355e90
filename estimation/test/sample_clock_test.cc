// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/base/sample_clock.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace touchdown::estimation {
namespace {

TEST(SampleClock, KeepsItsRateForAnHourWithoutDrift) {
  for (const double rate : {10.0, 20.0, 30.0, 7.0}) {
    SampleClock clock(rate);
    long samples = 0;
    const long steps = 1800000;  // 3600 s of 2 ms
    for (long i = 0; i < steps; ++i) {
      if (!clock.Due(static_cast<double>(i) * 0.002)) continue;
      const double due = static_cast<double>(samples) / rate;
      ASSERT_GE(static_cast<double>(i) * 0.002, due - 1e-6);
      ASSERT_LT(static_cast<double>(i) * 0.002, due + 0.002 + 1e-6);
      ++samples;
    }
    EXPECT_EQ(samples, std::lround(3600.0 * rate)) << rate;
  }
}

TEST(SampleClock, StartsLaterAndSkipsWhatAStepPassed) {
  SampleClock clock(10.0, 0.05);
  EXPECT_FALSE(clock.Due(0.0));
  EXPECT_TRUE(clock.Due(0.05));
  EXPECT_FALSE(clock.Due(0.05));
  EXPECT_TRUE(clock.Due(0.48));  // 0.15, 0.25, 0.35 and 0.45 passed: one sample
  EXPECT_FALSE(clock.Due(0.50));
  EXPECT_TRUE(clock.Due(0.55));
}

TEST(SampleClock, RefusesBadRates) {
  EXPECT_THROW(SampleClock(0.0), std::invalid_argument);
  EXPECT_THROW(SampleClock(std::nan("")), std::invalid_argument);
  EXPECT_THROW(SampleClock(10.0, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::estimation
