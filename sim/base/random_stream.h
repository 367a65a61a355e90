// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

#include <Eigen/Core>

namespace touchdown::sim {

/// A separate random generator for each purpose ("world", "start", "pad", "gps", ...). It is seeded
/// from the trial's seed and the purpose's name, so more or fewer draws from one never shift
/// another. The same (seed, name) gives the same draws. Not to be shared between threads.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Uniform in [low, high). Throws std::invalid_argument unless low <= high, both finite.
  double Uniform(double low, double high);

  /// A seed for another generator, below 2^53.
  std::uint64_t Seed();

  /// Normal with mean 0 and standard deviation `sigma` >= 0. A draw is used even when sigma is 0,
  /// so that a sensor made exact keeps its later draws where they were.
  double Normal(double sigma);
  /// Three of them.
  Eigen::Vector3d Normal3(double sigma);

 private:
  double UnitDraw();  // uniform in [0, 1)

  std::mt19937_64 engine_;
  double spare_ = 0.0;  // second of a pair of normal draws
  bool has_spare_ = false;
};

}  // namespace touchdown::sim
