// SPDX-License-Identifier: BSD-3-Clause
// Layout of the pad's markers. Large ones can be seen from afar. They surround a small one, which
// still fits in the image of a camera close above it.

#include "estimation/tags/pad_tags.h"

namespace touchdown::estimation {

Eigen::Matrix<double, 2, 4> PadTag::Corners() const {
  const double h = 0.5 * side;
  Eigen::Matrix<double, 2, 4> corners;
  corners << -h, h, h, -h, -h, -h, h, h;
  return corners.colwise() + center_P;
}

const std::array<PadTag, kPadTagCount>& PadTags() {
  constexpr double kOffset = 0.36;      // of the large tags' centres [m]
  constexpr double kOuterSide = 0.4;    // [m]
  constexpr double kCenterSide = 0.15;  // [m]
  static const std::array<PadTag, kPadTagCount> tags = {{{0, {0.0, 0.0}, kCenterSide},
                                                         {1, {kOffset, kOffset}, kOuterSide},
                                                         {2, {-kOffset, kOffset}, kOuterSide},
                                                         {3, {-kOffset, -kOffset}, kOuterSide},
                                                         {4, {kOffset, -kOffset}, kOuterSide}}};
  return tags;
}

}  // namespace touchdown::estimation
