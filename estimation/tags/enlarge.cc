// SPDX-License-Identifier: BSD-3-Clause
// Catmull-Rom interpolation (R. Keys, "Cubic convolution interpolation for digital image
// processing", 1981, a = -1/2), first along columns, then along rows. New pixel centres lie a
// quarter of an old pixel to either side of an old centre, so two sets of four weights are enough.
// The last pixel continues the border.

#include "estimation/tags/enlarge.h"

#include <algorithm>
#include <array>

namespace touchdown::estimation {
namespace {

// Weights at 1/4 behind the second of four samples; for 3/4 in reverse order. In 1/128, exact.
constexpr std::array<int, 4> kWeights = {-9, 111, 29, -3};

int Clamped(int i, int size) { return std::clamp(i, 0, size - 1); }

std::uint8_t Rounded(int value, int shift) {
  return static_cast<std::uint8_t>(std::clamp((value + (1 << (shift - 1))) >> shift, 0, 255));
}

}  // namespace

void EnlargeTwice(const GrayImageView& image, GrayImage* twice) {
  twice->width = 2 * image.width;
  twice->height = 2 * image.height;
  twice->pixels.resize(static_cast<std::size_t>(twice->width) *
                       static_cast<std::size_t>(twice->height));
  const auto column = [&](int row, int u) {  // 128 times the level between rows
    const int half = row / 2;
    const int sign = row % 2 == 0 ? -1 : 1;
    int sum = 0;
    for (int k = 0; k < 4; ++k) {
      const int v = Clamped(half + sign * (k - 1), image.height);
      sum += kWeights[static_cast<std::size_t>(k)] * image.data[v * image.stride + u];
    }
    return sum;
  };
  std::uint8_t* out = twice->pixels.data();
  for (int row = 0; row < twice->height; ++row) {
    std::array<int, 5> level{};  // of columns u - 2 to u + 2
    for (int i = 0; i < 5; ++i) {
      level[static_cast<std::size_t>(i)] = column(row, Clamped(i - 2, image.width));
    }
    for (int u = 0; u < image.width; ++u) {
      *out++ = Rounded(kWeights[3] * level[0] + kWeights[2] * level[1] + kWeights[1] * level[2] +
                           kWeights[0] * level[3],
                       14);
      *out++ = Rounded(kWeights[0] * level[1] + kWeights[1] * level[2] + kWeights[2] * level[3] +
                           kWeights[3] * level[4],
                       14);
      std::rotate(level.begin(), level.begin() + 1, level.end());
      level[4] = column(row, Clamped(u + 3, image.width));
    }
  }
}

}  // namespace touchdown::estimation
