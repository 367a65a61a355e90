// SPDX-License-Identifier: BSD-3-Clause
// mt19937_64, seeded through std::seed_seq, whose mixing the standard fixes. The seed sequence gets
// the 64 bits of the seed and the 64-bit FNV-1a hash of the name. So near seeds and similar names
// give unrelated streams. Uniform draws take the upper 53 bits. Normal draws use Marsaglia's polar
// method and keep the second of each pair. Both are written out because the standard does not fix
// the algorithms of its distributions.

#include "sim/base/random_stream.h"

#include <cmath>
#include <limits>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

std::uint64_t Fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

std::mt19937_64 SeededEngine(std::uint64_t seed, std::string_view name) {
  const std::uint64_t hash = Fnv1a(name);
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32)};
  return std::mt19937_64(words);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name)
    : engine_(SeededEngine(seed, name)) {}

double RandomStream::UnitDraw() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double RandomStream::Uniform(double low, double high) {
  constexpr double kLargest = std::numeric_limits<double>::max() / 2.0;
  estimation::CheckWithin("Uniform: low", low, -kLargest, kLargest);
  estimation::CheckWithin("Uniform: high", high, low, kLargest);
  const double draw = low + (high - low) * UnitDraw();
  return draw < high ? draw : low;  // rounding must not reach the open end
}

std::uint64_t RandomStream::Seed() { return static_cast<std::uint64_t>(Uniform(0.0, 0x1.0p53)); }

double RandomStream::Normal(double sigma) {
  estimation::CheckWithin("Normal: sigma", sigma, 0.0, std::numeric_limits<double>::max());
  if (has_spare_) {
    has_spare_ = false;
    return sigma * spare_;
  }
  double x = 0.0;
  double y = 0.0;
  double r2 = 0.0;
  do {
    x = 2.0 * UnitDraw() - 1.0;
    y = 2.0 * UnitDraw() - 1.0;
    r2 = x * x + y * y;
  } while (r2 >= 1.0 || r2 == 0.0);
  const double scale = std::sqrt(-2.0 * std::log(r2) / r2);
  spare_ = y * scale;
  has_spare_ = true;
  return sigma * x * scale;
}

Eigen::Vector3d RandomStream::Normal3(double sigma) {
  const double x = Normal(sigma), y = Normal(sigma), z = Normal(sigma);
  return {x, y, z};
}

}  // namespace touchdown::sim
