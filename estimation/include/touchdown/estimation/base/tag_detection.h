// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace touchdown::estimation {

/// One of the pad's tags found in an image.
struct TagDetection {
  int id = 0;
  /// Corners in the image [pixel], columns in the order of PadTag::Corners(); a pixel (u, v) has its
  /// centre at (u + 0.5, v + 0.5).
  Eigen::Matrix<double, 2, 4> corners = Eigen::Matrix<double, 2, 4>::Zero();
  double decision_margin =
      0.0;          ///< mean distance of a bit's grey level from black or white's border
  int hamming = 0;  ///< bits that were wrong
};

}  // namespace touchdown::estimation
