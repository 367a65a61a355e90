// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace touchdown::sim {

/// The constants of the fast tag camera. They describe rendered images of the pad and the result of
/// estimation::PadFinder on them. Made by `touchdown study tags --fit` (docs/tag_pose.md).
struct TagModel {
  /// A tag in view is found with probability Phi((size - half_size) / spread), size its shortest
  /// side and Phi the normal distribution.
  double half_size = 8.98;  ///< [pixel]
  double spread = 1.13;     ///< [pixel], > 0

  static constexpr std::size_t kKnots = 9;
  /// Sizes of the largest tag in view [pixel]; between them is interpolated, beyond them not.
  std::array<double, kKnots> size = {6.5, 8.0, 9.0, 10.0, 12.0, 15.0, 20.0, 30.0, 60.0};
  /// Noise of the corners of the tags that are found [pixel].
  std::array<double, kKnots> corner_sigma = {0.224, 0.224, 0.224, 0.224, 0.224,
                                             0.224, 0.224, 0.076, 0.044};
  /// The same where the whole sheet is aligned with the image: of all tags with their centre in it, found or not.
  std::array<double, kKnots> sheet_sigma = {0.0405, 0.0405, 0.0373, 0.0200, 0.0103,
                                            0.0140, 0.0119, 0.0119, 0.0119};
};

/// Value at a size of a table over TagModel::size.
double At(const TagModel& model, const std::array<double, TagModel::kKnots>& table, double size);

}  // namespace touchdown::sim
