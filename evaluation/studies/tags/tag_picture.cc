// SPDX-License-Identifier: BSD-3-Clause
// Lines are drawn point by point, a third of a pixel of the large image apart.
#include "evaluation/studies/tags/tag_picture.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "estimation/tags/pad_sheet.h"

namespace touchdown::evaluation {
namespace {

constexpr int kScale = 3;

using Color = std::array<std::uint8_t, 3>;
constexpr Color kYellow = {255, 220, 0};
constexpr Color kGreen = {0, 220, 60};
constexpr Color kRed = {240, 40, 40};

class Picture {
 public:
  explicit Picture(const estimation::GrayImage& image)
      : width_(kScale * image.width),
        height_(kScale * image.height),
        rgb_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
    for (int v = 0; v < height_; ++v) {
      for (int u = 0; u < width_; ++u) {
        const auto pixel = static_cast<std::size_t>(v / kScale * image.width + u / kScale);
        rgb_[static_cast<std::size_t>(v * width_ + u)].fill(image.pixels[pixel]);
      }
    }
  }

  /// From a to b, in pixels of the small image.
  void Line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Color& color) {
    const double length = kScale * (b - a).norm();
    if (!(length < 1e5)) return;
    const int steps = static_cast<int>(3.0 * length) + 1;
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d at = kScale * (a + (b - a) * i / steps);
      const int u = static_cast<int>(std::floor(at.x()));
      const int v = static_cast<int>(std::floor(at.y()));
      if (u < 0 || u >= width_ || v < 0 || v >= height_) continue;
      rgb_[static_cast<std::size_t>(v * width_ + u)] = color;
    }
  }

  void Write(const std::string& path) const {
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << width_ << ' ' << height_ << "\n255\n";
    for (const Color& color : rgb_) {
      for (const std::uint8_t level : color) file.put(static_cast<char>(level));
    }
    if (!file.flush()) throw std::runtime_error(path + " cannot be written.");
  }

 private:
  int width_;
  int height_;
  std::vector<Color> rgb_;
};

void DrawSheet(const estimation::PadPose& pose, const estimation::CameraIntrinsics& camera,
               Picture* picture) {
  constexpr double kHalf = 0.5 * estimation::kPadSheetSide;
  std::array<Eigen::Vector2d, 6> points;
  const std::array<Eigen::Vector2d, 6> on_pad = {{{-kHalf, -kHalf},
                                                  {kHalf, -kHalf},
                                                  {kHalf, kHalf},
                                                  {-kHalf, kHalf},
                                                  {0.0, 0.0},
                                                  {kHalf, 0.0}}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d x_C =
        pose.R_CP * Eigen::Vector3d(on_pad[i].x(), on_pad[i].y(), 0.0) + pose.p_CP;
    if (x_C.z() < 0.01) return;
    points[i] = camera.focal * x_C.head<2>() / x_C.z() + Eigen::Vector2d(camera.cx, camera.cy);
  }
  for (std::size_t i = 0; i < 4; ++i) picture->Line(points[i], points[(i + 1) % 4], kRed);
  picture->Line(points[4], points[5], kRed);
}

}  // namespace

void WriteTagPicture(const std::string& path, const estimation::GrayImage& image,
                     const estimation::PadView& view, const estimation::CameraIntrinsics& camera) {
  Picture picture(image);
  for (const estimation::TagDetection& tag : view.tags) {
    for (int k = 3; k >= 0; --k) {
      picture.Line(tag.corners.col(k), tag.corners.col((k + 1) % 4), k == 0 ? kYellow : kGreen);
    }
  }
  if (view.pose.status == estimation::PadPoseStatus::kSolved) {
    DrawSheet(view.pose, camera, &picture);
  }
  picture.Write(path);
}

}  // namespace touchdown::evaluation
