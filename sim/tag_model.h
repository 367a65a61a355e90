// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace touchdown::sim {

/// What a rendered image of the pad, and what estimation::PadFinder makes of it, comes to: the
/// constants of the fast tag camera. Made by `touchdown study tags --fit` (docs/tag_pose.md).
struct TagModel {
  /// A tag in view is found where (size - half_size) / spread + noise > 0, size its shortest side
  /// and noise standard normal, a part of it common to all tags of an image.
  double half_size = 8.7;  ///< [pixel]
  double spread = 1.0;     ///< [pixel]
  double common = 0.7;     ///< share of the noise's variance, in [0, 1]

  static constexpr std::size_t kKnots = 7;
  /// Sizes of the largest tag in view [pixel]; between them is interpolated, beyond them not.
  std::array<double, kKnots> size = {8.0, 10.0, 12.0, 15.0, 20.0, 30.0, 60.0};
  /// Noise of the corners of the tags that are found [pixel].
  std::array<double, kKnots> corner_sigma = {0.2, 0.2, 0.2, 0.15, 0.1, 0.1, 0.1};
  /// The same where the whole sheet is aligned with the image: of all tags in view, found or not.
  std::array<double, kKnots> sheet_sigma = {0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02};
};

/// Value at a size of a table over TagModel::size.
double At(const TagModel& model, const std::array<double, TagModel::kKnots>& table, double size);

}  // namespace touchdown::sim
