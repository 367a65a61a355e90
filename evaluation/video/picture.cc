// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/picture.h"

#include <algorithm>
#include <cmath>

namespace touchdown::evaluation {

Picture::Picture(int w, int h)
    : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

void Picture::Blend(int x, int y, const Rgb& color, double opacity) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  std::uint8_t* const pixel = rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x);
  const int share = static_cast<int>(256.0 * opacity + 0.5);
  for (std::size_t c = 0; c < 3; ++c) {
    pixel[c] = static_cast<std::uint8_t>((pixel[c] * (256 - share) + color[c] * share) >> 8);
  }
}

void Picture::Fill(const PictureArea& area, const Rgb& color, double opacity) {
  for (int y = area.top; y < area.top + area.height; ++y) {
    for (int x = area.left; x < area.left + area.width; ++x) Blend(x, y, color, opacity);
  }
}

void Picture::Put(const PictureArea& area, const Picture& other) {
  for (int y = std::max(0, -area.top); y < std::min(area.height, height - area.top); ++y) {
    const int v = y * other.height / area.height;
    for (int x = std::max(0, -area.left); x < std::min(area.width, width - area.left); ++x) {
      const int u = x * other.width / area.width;
      std::copy_n(
          other.rgb.data() + 3 * (static_cast<std::size_t>(v) * other.width + u), 3,
          rgb.data() + 3 * (static_cast<std::size_t>(area.top + y) * width + area.left + x));
    }
  }
}

void Picture::Line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double line_width,
                   const Rgb& color) {
  const double reach = 0.5 * line_width + 1.0;
  const Eigen::Vector2d low = a.cwiseMin(b).array() - reach, high = a.cwiseMax(b).array() + reach;
  const Eigen::Vector2d ab = b - a;
  const double squared = std::max(ab.squaredNorm(), 1e-12);
  const auto inside = [](double value, int most) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  for (int y = inside(low.y(), height); y < inside(high.y(), height); ++y) {
    for (int x = inside(low.x(), width); x < inside(high.x(), width); ++x) {
      const Eigen::Vector2d p(x + 0.5, y + 0.5);
      const double s = std::clamp((p - a).dot(ab) / squared, 0.0, 1.0);
      const double off = (p - a - s * ab).norm();
      Blend(x, y, color, std::clamp(0.5 * line_width + 0.5 - off, 0.0, 1.0));
    }
  }
}

void Picture::Text(int x, int y, std::string_view text, const sim::Font& font, const Rgb& color) {
  for (const char letter : text) {
    const sim::Font::Glyph& glyph = font.Of(letter);
    auto coverage = glyph.coverage.begin();
    for (int row = 0; row < font.height(); ++row) {
      for (int column = 0; column < glyph.width; ++column) {
        const int covered = *coverage++;
        if (covered > 0) Blend(x + column, y + row, color, covered / 255.0);
      }
    }
    x += glyph.width;
  }
}

}  // namespace touchdown::evaluation
