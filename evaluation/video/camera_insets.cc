// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/camera_insets.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "estimation/tags/pad_tags.h"
#include "evaluation/flight/depth_sensor.h"
#include "evaluation/flight/pad_sensor.h"

namespace touchdown::evaluation {
namespace {

constexpr Rgb kInsetText = {255, 255, 255};
constexpr Rgb kStrip = {16, 22, 32};  // behind text
constexpr double kStripOpacity = 0.72;
constexpr Rgb kFound = {60, 255, 120};  // outlines of tags
constexpr Rgb kNothing = {38, 40, 48};  // no return within the range

// From near to far, in equal steps: near is warm.
constexpr Rgb kNearToFar[] = {{250, 235, 120}, {252, 170, 60}, {235, 100, 60}, {190, 55, 95},
                              {120, 40, 130},  {60, 50, 150},  {30, 70, 140}};

Rgb ColorOf(double share) {
  constexpr int kSteps = static_cast<int>(std::size(kNearToFar)) - 1;
  const double at = std::clamp(share, 0.0, 1.0) * kSteps;
  const int i = std::min(static_cast<int>(at), kSteps - 1);
  Rgb color;
  for (std::size_t c = 0; c < 3; ++c) {
    const double from = kNearToFar[i][c], to = kNearToFar[i + 1][c];
    color[c] = static_cast<std::uint8_t>(std::lround(from + (at - i) * (to - from)));
  }
  return color;
}

sim::VisualScene Uncovered(sim::VisualScene scene) {
  scene.occlusion = 0.0;
  return scene;
}

// A title over an image; returns where the image is.
PictureArea DrawInset(const PictureArea& area, const std::string& title, const Picture& image,
                      const sim::Font& font, Picture* picture) {
  const int strip = font.height() + font.height() / 4;
  const PictureArea shown = {area.left, area.top + strip, area.width,
                             area.width * image.height / image.width};
  const int edge = std::max(1, area.width / 144);
  picture->Fill(
      {area.left - edge, area.top - edge, area.width + 2 * edge, strip + shown.height + 2 * edge},
      kStrip, kStripOpacity);
  picture->Text(area.left + font.height() / 4, area.top + font.height() / 8, title, font,
                kInsetText);
  picture->Put(shown, image);
  return shown;
}

}  // namespace

CameraInsets::CameraInsets(const Scenario& scenario, const sim::VisualScene& scene)
    : pad_camera_(PadCameraOf(scenario), scene, scenario.seed),
      depth_camera_(DepthCamerasOf(scenario).front().config, Uncovered(scene), scenario.seed),
      pad_clock_(scenario.tag_rate),
      depth_clock_(DepthCamerasOf(scenario).front().rate) {}

void CameraInsets::Look(const TrackSample& now) {
  if (pad_clock_.Due(now.vehicle.t)) LookDown(now);
  if (depth_clock_.Due(now.vehicle.t)) LookAhead(now);
}

void CameraInsets::LookDown(const TrackSample& now) {
  pad_camera_.Capture(now.vehicle, now.pad, &gray_);
  tags_ = finder_.Find(gray_.View(), pad_camera_.intrinsics()).tags;
  down_ = Picture(gray_.width, gray_.height);
  auto rgb = down_.rgb.begin();
  for (const std::uint8_t level : gray_.pixels) rgb = std::fill_n(rgb, 3, level);
}

void CameraInsets::LookAhead(const TrackSample& now) {
  depth_camera_.Capture(now.vehicle, now.pad, &frame_);
  ahead_ = Picture(frame_.intrinsics.width, frame_.intrinsics.height);
  auto rgb = ahead_.rgb.begin();
  for (const float depth : frame_.depth) {
    const Rgb color =
        std::isfinite(depth) ? ColorOf(static_cast<double>(depth) / frame_.max_range) : kNothing;
    rgb = std::copy(color.begin(), color.end(), rgb);
  }
}

void CameraInsets::Draw(const PictureArea& area, int gap, const sim::Font& font,
                        Picture* picture) const {
  const std::string found =
      tags_.empty() ? "no tag found"
                    : fmt::format("{} of {} tags found", tags_.size(), estimation::kPadTagCount);
  const PictureArea down =
      DrawInset(area, fmt::format("camera down: {}", found), down_, font, picture);
  const double scale = static_cast<double>(down.width) / down_.width;
  for (const estimation::TagDetection& tag : tags_) {
    const auto corner = [&](int i) -> Eigen::Vector2d {
      return Eigen::Vector2d(down.left, down.top) + scale * tag.corners.col(i % 4);
    };
    for (int i = 0; i < 4; ++i) {
      picture->Line(corner(i), corner(i + 1), std::max(1.0, area.width / 130.0), kFound);
    }
  }
  const PictureArea ahead = DrawInset({area.left, down.top + down.height + gap, area.width, 0},
                                      "depth camera", ahead_, font, picture);
  // The legend stands in the title's line, at its right: a bar of the colours from 0 to the range.
  const std::string range = fmt::format("{:g} m", frame_.max_range);
  const int height = font.height() / 2;
  const int right = area.left + area.width - font.height() / 4 - font.WidthOf(range);
  const int width = area.width / 4;
  const int top = ahead.top - font.height() - font.height() / 8;
  picture->Text(right, top, range, font, kInsetText);
  const int left = right - width - font.height() / 4;
  for (int x = 0; x < width; ++x) {
    picture->Fill({left + x, top + font.height() / 4, 1, height}, ColorOf((x + 0.5) / width), 1.0);
  }
  picture->Text(left - font.WidthOf("0 "), top, "0", font, kInsetText);
}

}  // namespace touchdown::evaluation
