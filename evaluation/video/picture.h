// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "sim/rendering/font.h"

namespace touchdown::evaluation {

using Rgb = std::array<std::uint8_t, 3>;

/// Part of a picture [pixel]; what lies outside of the picture is not drawn.
struct PictureArea {
  int left = 0, top = 0, width = 0, height = 0;
};

/// A picture that is drawn on. Row 0 is the top.
struct Picture {
  int width = 0, height = 0;      ///< [pixel]
  std::vector<std::uint8_t> rgb;  ///< height x width x 3, row-major

  Picture() = default;
  Picture(int width, int height);

  /// Softens stairs along edges of brightness (FXAA), as a camera would; the rest stays as it is.
  void SmoothEdges();
  /// Mixes a colour in. @param opacity in [0, 1].
  void Blend(int x, int y, const Rgb& color, double opacity);
  void Fill(const PictureArea& area, const Rgb& color, double opacity);
  /// Puts another picture there, as large as the area: every pixel is the nearest one.
  void Put(const PictureArea& area, const Picture& other);
  /// A line of this width between two points, pixel (u, v) has its centre at (u + 0.5, v + 0.5).
  void Line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width, const Rgb& color);
  /// One line of text with its upper left corner there.
  void Text(int x, int y, std::string_view text, const sim::Font& font, const Rgb& color);
};

}  // namespace touchdown::evaluation
