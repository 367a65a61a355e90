// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/random_stream.h"

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

TEST(RandomStream, SameSeedAndNameGiveTheSameDraws) {
  RandomStream a(42, "gps");
  RandomStream b(42, "gps");
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(a.Normal(1.0), b.Normal(1.0));
    EXPECT_EQ(a.Uniform(-1.0, 3.0), b.Uniform(-1.0, 3.0));
  }
}

TEST(RandomStream, NearSeedsAndSimilarNamesShareNothing) {
  std::set<double> draws;
  int count = 0;
  for (const std::uint64_t seed : {0ULL, 1ULL, 2ULL, 1ULL << 32, ~0ULL}) {
    for (const char* name : {"", "a", "b", "ab", "ba", "gps", "tag camera"}) {
      RandomStream stream(seed, name);
      for (int i = 0; i < 50; ++i, ++count) draws.insert(stream.Uniform(0.0, 1.0));
    }
  }
  EXPECT_EQ(draws.size(), static_cast<std::size_t>(count));
}

TEST(RandomStream, StreamsAreUncorrelated) {
  RandomStream a(7, "wind");
  RandomStream b(7, "gps");
  const int n = 20000;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += a.Normal(1.0) * b.Normal(1.0);
  EXPECT_LT(std::abs(sum / n), 4.0 / std::sqrt(n));
}

TEST(RandomStream, MomentsOfUniformAndNormal) {
  RandomStream random(1, "moments");
  const int n = 100000;
  double mean = 0.0;
  double square = 0.0;
  double fourth = 0.0;
  double uniform = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = random.Normal(2.0) / 2.0;
    mean += x / n;
    square += x * x / n;
    fourth += x * x * x * x / n;
    const double u = random.Uniform(-1.0, 5.0);
    ASSERT_GE(u, -1.0);
    ASSERT_LT(u, 5.0);
    uniform += u / n;
  }
  EXPECT_NEAR(mean, 0.0, 0.015);
  EXPECT_NEAR(square, 1.0, 0.02);
  EXPECT_NEAR(fourth, 3.0, 0.15);
  EXPECT_NEAR(uniform, 2.0, 0.025);
}

TEST(RandomStream, AnExactSensorUsesAsManyDraws) {
  RandomStream exact(5, "gps");
  RandomStream noisy(5, "gps");
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(exact.Normal(0.0), 0.0);
    noisy.Normal(1.0);
  }
  EXPECT_EQ(exact.Normal(1.0), noisy.Normal(1.0));
}

TEST(RandomStream, RefusesBadRanges) {
  RandomStream random(1, "x");
  EXPECT_EQ(random.Uniform(2.0, 2.0), 2.0);
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([&] { random.Uniform(1.0, 0.0); }),
              ::testing::HasSubstr("high is 0; allowed is [1,"));
  EXPECT_THROW(random.Normal(-1.0), std::invalid_argument);
  EXPECT_THROW(random.Normal(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
