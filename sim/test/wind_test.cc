// SPDX-License-Identifier: BSD-3-Clause
#include "sim/air/wind.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

constexpr double kStep = 0.002;  // [s]

estimation::VehicleState Hovering(double t) {
  estimation::VehicleState vehicle;
  vehicle.t = t;
  vehicle.p_WB.z() = 3.0;
  return vehicle;
}

std::vector<Eigen::Vector3d> Blow(const WindConfig& config, std::uint64_t seed, int count,
                                  double dt) {
  Wind wind(config, seed);
  std::vector<Eigen::Vector3d> series;
  for (int i = 0; i < count; ++i) series.push_back(wind.Step(Hovering(i * dt), dt));
  return series;
}

WindConfig Config(double mean, double max, double direction = 0.0) {
  WindConfig config;
  config.mean = mean;
  config.max = max;
  config.direction = direction;
  return config;
}

TEST(Wind, StillAirIsExactlyStill) {
  for (const Eigen::Vector3d& air : Blow({}, 1, 50, kStep)) {
    EXPECT_EQ(air, Eigen::Vector3d::Zero());
  }
}

TEST(Wind, SteadyWindBlowsWhereItShould) {
  const Eigen::Vector3d to_the_left =
      Blow(Config(7.0, 7.0, 0.5 * std::numbers::pi), 1, 1, kStep)[0];
  EXPECT_LT((to_the_left - Eigen::Vector3d(0.0, 7.0, 0.0)).norm(), 1e-12);
  const auto series = Blow(Config(4.0, 4.0, 2.1), 1, 50, kStep);
  for (const Eigen::Vector3d& air : series) EXPECT_EQ(air, series.front());
}

TEST(Wind, IsCutOffAtItsGreatestSpeed) {
  double fastest = 0.0;
  int at_the_limit = 0;
  const auto series = Blow(Config(11.0, 15.0), 2, 100000, 0.02);
  for (const Eigen::Vector3d& air : series) {
    fastest = std::max(fastest, air.norm());
    if (air.norm() > 15.0 - 1e-9) ++at_the_limit;
  }
  EXPECT_LE(fastest, 15.0 + 1e-12);
  // Two standard deviations: 2.3 % of a normal's draws are above, more with the other components.
  EXPECT_GT(at_the_limit, 500);
  EXPECT_LT(at_the_limit, 8000);
}

TEST(Wind, MeanAndTurbulenceFollowFromTheTwoSpeeds) {
  const double direction = 0.7;
  const auto series = Blow(Config(7.0, 11.0, direction), 3, 200000, 0.05);
  const Eigen::Vector3d along(std::cos(direction), std::sin(direction), 0.0);
  const Eigen::Vector3d left(-along.y(), along.x(), 0.0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& air : series) {
    const Eigen::Vector3d n(air.dot(along) - 7.0, air.dot(left), air.z());
    sum += n;
    squares += n.cwiseProduct(n);
  }
  sum /= static_cast<double>(series.size());
  const Eigen::Vector3d sigma = (squares / static_cast<double>(series.size())).cwiseSqrt();
  // Sigma is 2 m/s; cutting off above two of them takes a little from the along component.
  EXPECT_NEAR(sum.x(), -0.05, 0.15);
  EXPECT_NEAR(sum.y(), 0.0, 0.1);
  EXPECT_NEAR(sigma.x(), 1.9, 0.1);
  EXPECT_NEAR(sigma.y(), 1.95, 0.1);
  EXPECT_NEAR(sigma.z(), 2.0 * DrydenScalesAt(3.0).vertical_ratio, 0.05);
}

TEST(Wind, FasterAirChangesFaster) {
  const auto roughness = [](double speed) {
    const auto series = Blow(Config(speed, speed + 2.0), 4, 20000, kStep);
    double sum = 0.0;
    for (std::size_t i = 1; i < series.size(); ++i) {
      sum += (series[i] - series[i - 1]).squaredNorm();
    }
    return sum;
  };
  EXPECT_NEAR(roughness(12.0) / roughness(3.0), 4.0, 0.8);  // of rates V / L
}

TEST(Wind, GustRisesAndFallsAsACosine) {
  WindConfig config = Config(5.0, 5.0, std::numbers::pi);
  config.gust = {4.0, 1.0, 2.0, 0.0};
  const Wind once(config, 1);
  EXPECT_EQ(once.GustAt(0.99), 0.0);
  EXPECT_NEAR(once.GustAt(1.5), 2.0, 1e-12);
  EXPECT_NEAR(once.GustAt(2.0), 4.0, 1e-12);
  EXPECT_NEAR(once.GustAt(2.999), 0.0, 1e-4);
  EXPECT_EQ(once.GustAt(12.0), 0.0);
  Wind wind(config, 1);
  EXPECT_LT((wind.Step(Hovering(2.0), kStep) - Eigen::Vector3d(-9.0, 0.0, 0.0)).norm(), 1e-12);
  config.gust.period = 5.0;
  EXPECT_NEAR(Wind(config, 1).GustAt(12.0), 4.0, 1e-12);
}

TEST(Wind, SameSeedSameBits) {
  const WindConfig config = Config(7.0, 11.0, 1.0);
  EXPECT_EQ(Blow(config, 5, 200, kStep), Blow(config, 5, 200, kStep));
  EXPECT_NE(Blow(config, 5, 200, kStep), Blow(config, 6, 200, kStep));
}

TEST(Wind, RefusesWhatIsNoWind) {
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([] { Wind(Config(7.0, 4.0), 1); }),
              testing::HasSubstr("wind.max is 4; allowed is [7, 40]"));
  WindConfig config;
  config.gust = {1.0, 0.0, 3.0, 2.0};
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([&] { Wind(config, 1); }),
              testing::HasSubstr("wind.gust.period is 2"));
}

}  // namespace
}  // namespace touchdown::sim
