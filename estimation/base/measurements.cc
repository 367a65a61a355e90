// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/base/measurements.h"

#include <cmath>
#include <cstddef>

namespace touchdown::estimation {
namespace {

constexpr double kWidest = 1e4;    // of an image plane, over the focal length
constexpr double kFarthest = 1e7;  // of a camera [m]
constexpr double kRotation = 1e-3;

// Written so that NaN fails each.
bool IsPossible(const CameraIntrinsics& k, const Eigen::Vector3d& place,
                const Eigen::Matrix3d& turn) {
  const double widest = kWidest * k.focal;
  const auto in_plane = [widest](double centre, int size) {
    return size > 0 && size <= widest && centre >= -widest && centre <= widest;
  };
  return k.focal > 0.0 && widest <= 1e12 && in_plane(k.cx, k.width) && in_plane(k.cy, k.height) &&
         (place.array().abs() < kFarthest).all() && turn.isUnitary(kRotation) &&
         turn.determinant() > 0.0;
}

std::size_t Pixels(const CameraIntrinsics& k) {
  return static_cast<std::size_t>(k.width) * static_cast<std::size_t>(k.height);
}

}  // namespace

bool IsPossible(const DepthFrame& frame) {
  return frame.max_range > 0.0 && IsPossible(frame.intrinsics, frame.p_WC, frame.R_WC);
}

bool IsPossible(const DepthImage& image) {
  return image.max_range > 0.0 && IsPossible(image.intrinsics, image.p_BC, image.R_BC) &&
         image.depth.size() == Pixels(image.intrinsics);
}

bool SaysSomething(const DepthImage& image) {
  std::ptrdiff_t within = 0, clear = 0, beyond = 0;
  for (const float depth : image.depth) {
    if (depth > 0.0F && depth <= image.max_range) ++within;
    if (depth > image.max_range) ++(std::isinf(depth) ? clear : beyond);
  }
  return within + clear > 0 && beyond <= within + clear;
}

bool IsPossible(const PadImage& image) {
  const GrayImage& gray = image.gray;
  return IsPossible(image.intrinsics, image.p_BC, image.R_BC) &&
         gray.width == image.intrinsics.width && gray.height == image.intrinsics.height &&
         gray.pixels.size() == Pixels(image.intrinsics);
}

}  // namespace touchdown::estimation
