// SPDX-License-Identifier: BSD-3-Clause
// Value noise around a middle grey: octaves of random lattices, from 8 cells a side up to one cell
// a texel. Each is interpolated bilinearly and half as strong as the one before.

#include "sim/rendering/ground_texture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/base/argument_check.h"
#include "sim/base/random_stream.h"

namespace touchdown::sim {
namespace {

constexpr int kCoarsest = 8;        // lattice cells a side
constexpr double kMiddle = 110.0;   // [grey level]
constexpr double kContrast = 40.0;  // of the coarsest octave, either way [grey level]
constexpr double kGrain = 8.0;      // no octave is weaker [grey level]

void AddOctave(int cells, double contrast, int texels, RandomStream* random,
               std::vector<double>* level) {
  std::vector<double> lattice(static_cast<std::size_t>(cells) * cells);
  for (double& value : lattice) value = random->Uniform(-contrast, contrast);
  const auto at = [&](int row, int column) {
    return lattice[static_cast<std::size_t>((row % cells) * cells + column % cells)];
  };
  const int step = texels / cells;
  for (int row = 0; row < texels; ++row) {
    const int i = row / step;
    const double a = static_cast<double>(row % step) / step;
    for (int column = 0; column < texels; ++column) {
      const int j = column / step;
      const double b = static_cast<double>(column % step) / step;
      (*level)[static_cast<std::size_t>(row * texels + column)] +=
          (1.0 - a) * ((1.0 - b) * at(i, j) + b * at(i, j + 1)) +
          a * ((1.0 - b) * at(i + 1, j) + b * at(i + 1, j + 1));
    }
  }
}

}  // namespace

estimation::GrayImage GroundTexture(int texels) {
  estimation::CheckWithin("ground texture [texel]", texels, kCoarsest, 4096);
  RandomStream random(0, "ground texture");
  std::vector<double> level(static_cast<std::size_t>(texels) * texels, kMiddle);
  double contrast = kContrast;
  for (int cells = kCoarsest; cells <= texels; cells *= 2, contrast *= 0.5) {
    AddOctave(cells, std::max(contrast, kGrain), texels, &random, &level);
  }
  estimation::GrayImage image;
  image.width = texels;
  image.height = texels;
  image.pixels.resize(level.size());
  std::transform(level.begin(), level.end(), image.pixels.begin(), [](double value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
  });
  return image;
}

}  // namespace touchdown::sim
