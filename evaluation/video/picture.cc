// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/picture.h"

#include <algorithm>
#include <cmath>

namespace touchdown::evaluation {
namespace {

constexpr int kLeastContrast = 14;  // of an edge [grey level]
constexpr double kReach = 6.0;      // along an edge, to each side at most [pixel]

// Of the picture as it was: what an edge's pixels are mixed from.
class Sharp {
 public:
  explicit Sharp(const Picture& picture)
      : width_(picture.width), height_(picture.height), rgb_(picture.rgb) {
    luma_.reserve(rgb_.size() / 3);
    for (std::size_t i = 0; i < rgb_.size(); i += 3) {
      luma_.push_back(
          static_cast<std::uint8_t>((77 * rgb_[i] + 150 * rgb_[i + 1] + 29 * rgb_[i + 2]) >> 8));
    }
  }

  int Luma(int x, int y) const { return luma_[static_cast<std::size_t>(y) * width_ + x]; }

  Eigen::Vector3d At(double x, double y) const {
    x = std::clamp(x, 0.0, width_ - 1.001);
    y = std::clamp(y, 0.0, height_ - 1.001);
    const int u = static_cast<int>(x), v = static_cast<int>(y);
    const double a = x - u, b = y - v;
    return (1.0 - b) * ((1.0 - a) * Pixel(u, v) + a * Pixel(u + 1, v)) +
           b * ((1.0 - a) * Pixel(u, v + 1) + a * Pixel(u + 1, v + 1));
  }

 private:
  Eigen::Vector3d Pixel(int x, int y) const {
    const std::uint8_t* const p = rgb_.data() + 3 * (static_cast<std::size_t>(y) * width_ + x);
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }

  int width_, height_;
  std::vector<std::uint8_t> rgb_, luma_;
};

double LumaOf(const Eigen::Vector3d& rgb) {
  return (77.0 * rgb.x() + 150.0 * rgb.y() + 29.0 * rgb.z()) / 256.0;
}

}  // namespace

void Picture::SmoothEdges() {
  const Sharp sharp(*this);
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const int nw = sharp.Luma(x - 1, y - 1), ne = sharp.Luma(x + 1, y - 1);
      const int sw = sharp.Luma(x - 1, y + 1), se = sharp.Luma(x + 1, y + 1);
      const int here = sharp.Luma(x, y);
      const auto [low, high] = std::minmax({nw, ne, sw, se, here});
      if (high - low < kLeastContrast) continue;
      // Along the edge: across the gradient.
      Eigen::Vector2d along(sw + se - nw - ne, nw + sw - ne - se);
      const double slow = std::max(std::min(std::abs(along.x()), std::abs(along.y())), 1.0);
      along = (along / slow).cwiseMax(-kReach).cwiseMin(kReach);
      const auto at = [&](double s) -> Eigen::Vector3d {
        return sharp.At(x + s * along.x(), y + s * along.y());
      };
      const Eigen::Vector3d near = 0.5 * (at(-1.0 / 6.0) + at(1.0 / 6.0));
      const Eigen::Vector3d far = 0.5 * near + 0.25 * (at(-0.5) + at(0.5));
      const double luma = LumaOf(far);
      // A pixel that is brighter or darker than all around belongs to another thing.
      const Eigen::Vector3d mixed = luma < low || luma > high ? near : far;
      std::uint8_t* const pixel = rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x);
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(std::lround(mixed[c]));
    }
  }
}

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
