// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/base/measurements.h"

namespace touchdown::estimation {
namespace {

constexpr double kWidest = 1e4;    // of an image plane, over the focal length
constexpr double kFarthest = 1e7;  // of a camera [m]
constexpr double kRotation = 1e-3;

}  // namespace

// Written so that a number that is none fails each.
bool IsPossible(const DepthFrame& frame) {
  const CameraIntrinsics& k = frame.intrinsics;
  const double widest = kWidest * k.focal;
  const auto in_plane = [widest](double centre, int size) {
    return size > 0 && size <= widest && centre >= -widest && centre <= widest;
  };
  return k.focal > 0.0 && widest <= 1e12 && in_plane(k.cx, k.width) && in_plane(k.cy, k.height) &&
         frame.max_range > 0.0 && (frame.p_WC.array().abs() < kFarthest).all() &&
         frame.R_WC.isUnitary(kRotation) && frame.R_WC.determinant() > 0.0;
}

}  // namespace touchdown::estimation
