// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchdown::estimation {

/// Someone else's image with 8 bits a pixel: 0 black, 255 white. Row 0 is the top; pixel (u, v) has
/// its centre at (u + 0.5, v + 0.5).
struct GrayImageView {
  const std::uint8_t* data = nullptr;
  int width = 0;   ///< [pixel]
  int height = 0;  ///< [pixel]
  int stride = 0;  ///< from one row to the next [byte], >= width
};

/// An image of one's own, rows without gaps.
struct GrayImage {
  int width = 0;                     ///< [pixel]
  int height = 0;                    ///< [pixel]
  std::vector<std::uint8_t> pixels;  ///< height x width, row-major

  GrayImageView View() const { return {pixels.data(), width, height, width}; }
};

}  // namespace touchdown::estimation
