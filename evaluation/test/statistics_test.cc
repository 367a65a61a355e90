// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/statistics.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

TEST(ClopperPearson, AllSucceedHasTheClosedForm) {
  // For k = n the lower bound is (alpha/2)^(1/n): 96.4 % for 100 of 100.
  const Interval interval = ClopperPearson(100, 100);
  EXPECT_NEAR(interval.lo, std::pow(0.025, 1.0 / 100.0), 1e-12);
  EXPECT_NEAR(interval.lo, 0.9638, 5e-5);
  EXPECT_DOUBLE_EQ(interval.hi, 1.0);
}

TEST(ClopperPearson, NoneSucceedsMirrorsAll) {
  const Interval none = ClopperPearson(0, 20);
  const Interval all = ClopperPearson(20, 20);
  EXPECT_DOUBLE_EQ(none.lo, 0.0);
  EXPECT_NEAR(none.hi, 1.0 - all.lo, 1e-12);
}

TEST(ClopperPearson, AgreesWithPublishedValues) {
  // R: binom.test(7, 10)$conf.int is 0.3475471 0.9332605; 99 of 100 is 0.9455406 0.9997469.
  EXPECT_NEAR(ClopperPearson(7, 10).lo, 0.3475471, 1e-6);
  EXPECT_NEAR(ClopperPearson(7, 10).hi, 0.9332605, 1e-6);
  EXPECT_NEAR(ClopperPearson(99, 100).lo, 0.9455406, 1e-6);
  EXPECT_NEAR(ClopperPearson(99, 100).hi, 0.9997469, 1e-6);
}

TEST(ClopperPearson, TheDesignsSampleSizesShowNinetyNinePercent) {
  EXPECT_GE(ClopperPearson(368, 368).lo, 0.99);
  EXPECT_LT(ClopperPearson(366, 366).lo, 0.99);
  EXPECT_GE(ClopperPearson(554, 555).lo, 0.99);
}

TEST(ClopperPearson, RefusesNonsense) {
  EXPECT_THROW(ClopperPearson(1, 0), std::invalid_argument);
  EXPECT_THROW(ClopperPearson(-1, 5), std::invalid_argument);
  EXPECT_THROW(ClopperPearson(6, 5), std::invalid_argument);
  EXPECT_THROW(ClopperPearson(1, 5, 1.0), std::invalid_argument);
}

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(*Quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(*Quantile({4.0, 1.0, 3.0, 2.0}, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(*Quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
  // numpy.quantile([1, 2, 3, 4], 0.95) = 3.85
  EXPECT_NEAR(*Quantile({1.0, 2.0, 3.0, 4.0}, 0.95), 3.85, 1e-12);
  EXPECT_DOUBLE_EQ(*Quantile({7.0}, 0.99), 7.0);
}

TEST(Quantile, OfNothingIsNothing) {
  EXPECT_FALSE(Quantile({}, 0.5).has_value());
  EXPECT_THROW(Quantile({1.0}, 1.5), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::evaluation
