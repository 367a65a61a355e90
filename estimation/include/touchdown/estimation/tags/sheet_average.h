// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace touchdown::estimation {

/// Mean grey level of the pad's printed sheet over rectangles along the pad's axes, each at the
/// same small cost whatever its size. White goes on beyond the sheet.
class SheetAverage {
 public:
  SheetAverage();

  /// @param center_P of the rectangle [m]. @param half_size half its sides [m], > 0.
  /// Exact up to the sheet's texels; continuous in all arguments. Does not allocate.
  double Over(const Eigen::Vector2d& center_P, const Eigen::Vector2d& half_size) const;

 private:
  double Integral(double column, double row) const;

  std::vector<float> sums_;  ///< of blackness above and left of each texel corner, in [0, texels^2]
};

}  // namespace touchdown::estimation
