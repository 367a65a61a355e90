// SPDX-License-Identifier: BSD-3-Clause
// Statistics against theory. Bounds are 4.5 standard deviations of the estimate, so that a right
// filter passes whatever its seed is.
#include "sim/air/dryden.h"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace touchdown::sim {
namespace {

constexpr double kHeight = 20.0;   // [m]
constexpr double kAirspeed = 8.0;  // [m/s]
constexpr double kSigmas = 4.5;

// `count` values of each component, in steps of `share` of the horizontal time scale; the vertical one
// is over its own standard deviation.
std::array<std::vector<double>, 3> Draw(int count, double share, std::uint64_t seed) {
  const DrydenScales scales = DrydenScalesAt(kHeight);
  DrydenTurbulence turbulence(seed);
  std::array<std::vector<double>, 3> series;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d n = turbulence.Step(share * scales.along / kAirspeed, kAirspeed, kHeight);
    series[0].push_back(n.x());
    series[1].push_back(n.y());
    series[2].push_back(n.z() / scales.vertical_ratio);
  }
  return series;
}

double Correlation(const std::vector<double>& x, int lag) {
  double sum = 0.0;
  const std::size_t count = x.size() - static_cast<std::size_t>(lag);
  for (std::size_t i = 0; i < count; ++i) sum += x[i] * x[i + static_cast<std::size_t>(lag)];
  return sum / static_cast<double>(count);
}

TEST(Dryden, ScalesAreThoseOfTheSpecification) {
  const DrydenScales low = DrydenScalesAt(100.0 * 0.3048);  // 100 ft
  EXPECT_NEAR(low.up, 100.0 * 0.3048, 1e-12);
  EXPECT_NEAR(low.along, 100.0 * 0.3048 / std::pow(0.2593, 1.2), 1e-9);
  EXPECT_NEAR(low.vertical_ratio, std::pow(0.2593, 0.4), 1e-12);
  const DrydenScales top = DrydenScalesAt(1000.0 * 0.3048);
  EXPECT_NEAR(top.along, top.up, 1e-6 * top.up);  // isotropic from 1000 ft on
  EXPECT_NEAR(top.vertical_ratio, 1.0, 1e-9);
  EXPECT_EQ(DrydenScalesAt(0.0).up, DrydenScalesAt(3.0).up);  // the form begins at 10 ft
  EXPECT_EQ(DrydenScalesAt(1e4).up, top.up);
}

TEST(Dryden, VarianceIsOneWhateverTheStep) {
  const std::array<double, 2> scale = {1.0,
                                       DrydenScalesAt(kHeight).along / DrydenScalesAt(kHeight).up};
  for (const double share : {0.002, 0.1, 3.0}) {
    const int count = 200000;
    const auto series = Draw(count, share, 11);
    for (int axis = 0; axis < 3; ++axis) {
      // Of the mean of squares: 2/n times the sum of the squared correlations, at most 1 + 2 tau/dt.
      const double d = share * (axis == 2 ? scale[1] : 1.0);
      const double bound = kSigmas * std::sqrt(2.0 / count * (1.0 + 1.0 / d));
      if (bound > 0.5) continue;  // says nothing
      EXPECT_NEAR(Correlation(series[axis], 0), 1.0, bound) << share << " axis " << axis;
    }
  }
}

TEST(Dryden, CorrelationFallsAsTheoryHasIt) {
  // exp(-s) along, (1 - s/2) exp(-s) across, in the component's own time scale.
  const auto series = Draw(400000, 0.1, 12);
  const double up = DrydenScalesAt(kHeight).along / DrydenScalesAt(kHeight).up;
  const double bound = kSigmas * std::sqrt(2.0 / 400000 * 11.0);
  for (const int lag : {1, 5, 10, 20, 40}) {
    const double s = 0.1 * lag;
    EXPECT_NEAR(Correlation(series[0], lag), std::exp(-s), bound) << lag;
    EXPECT_NEAR(Correlation(series[1], lag), (1.0 - 0.5 * s) * std::exp(-s), bound) << lag;
    EXPECT_NEAR(Correlation(series[2], lag), (1.0 - 0.5 * s * up) * std::exp(-s * up), bound)
        << lag;
  }
}

TEST(Dryden, SpectrumIsThatOfTheShapingFilters) {
  constexpr int kSegments = 1500;
  constexpr int kLength = 512;
  constexpr double kShare = 0.1;
  const auto series = Draw(kSegments * kLength, kShare, 13);
  std::vector<double> window(kLength);
  double energy = 0.0;
  for (int i = 0; i < kLength; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / kLength);
    energy += window[i] * window[i];
  }
  for (const int bin : {4, 8, 16, 32}) {
    const double w = 2.0 * std::numbers::pi * bin / (kLength * kShare);  // times tau
    const std::array<double, 2> theory = {2.0 / (1.0 + w * w),
                                          (1.0 + 3.0 * w * w) / ((1.0 + w * w) * (1.0 + w * w))};
    for (int axis = 0; axis < 2; ++axis) {
      double power = 0.0;
      for (int segment = 0; segment < kSegments; ++segment) {
        std::complex<double> sum = 0.0;
        for (int i = 0; i < kLength; ++i) {
          sum += window[i] * series[axis][segment * kLength + i] *
                 std::polar(1.0, -2.0 * std::numbers::pi * bin * i / kLength);
        }
        power += std::norm(sum) * kShare / energy;
      }
      // Each segment's estimate has the standard deviation of its mean; 3 % for window and aliasing.
      const double bound = kSigmas / std::sqrt(kSegments) + 0.03;
      EXPECT_NEAR(power / kSegments / theory[axis], 1.0, bound) << bin << " axis " << axis;
    }
  }
}

TEST(Dryden, StaysStationaryWhileSpeedAndHeightChange) {
  DrydenTurbulence turbulence(14);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double height = i % 7 < 3 ? 4.0 : 60.0;
    Eigen::Vector3d n = turbulence.Step(0.5, i % 2 == 0 ? 2.0 : 14.0, height);
    n.z() /= DrydenScalesAt(height).vertical_ratio;
    sum += n.cwiseProduct(n);
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(sum[axis] / kCount, 1.0, 0.1) << axis;
}

TEST(Dryden, ComponentsAreIndependent) {
  const auto series = Draw(200000, 1.0, 15);
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < a; ++b) {
      double sum = 0.0;
      for (std::size_t i = 0; i < series[a].size(); ++i) sum += series[a][i] * series[b][i];
      EXPECT_NEAR(sum / 200000, 0.0, kSigmas * std::sqrt(2.0 / 200000)) << a << b;
    }
  }
}

TEST(Dryden, SameSeedSameBits) {
  EXPECT_EQ(Draw(100, 0.1, 3), Draw(100, 0.1, 3));
  EXPECT_NE(Draw(100, 0.1, 3)[0], Draw(100, 0.1, 4)[0]);
}

}  // namespace
}  // namespace touchdown::sim
