// SPDX-License-Identifier: BSD-3-Clause
// A summed-area table (F. Crow, "Summed-area tables for texture mapping", 1984) of the sheet's
// blackness, which is zero at the edge, so that clamping continues the white. Between texel corners
// the integral of a piecewise constant image is bilinear: interpolation is exact. Whole numbers up to
// 2^20 are exact in a float.

#include "touchdown/estimation/tags/sheet_average.h"

#include <algorithm>
#include <cmath>

#include "estimation/tags/pad_sheet.h"

namespace touchdown::estimation {
namespace {

constexpr int kCorners = kPadSheetTexels + 1;
constexpr double kTexelsPerMeter = kPadSheetTexels / kPadSheetSide;

}  // namespace

SheetAverage::SheetAverage() : sums_(static_cast<std::size_t>(kCorners) * kCorners, 0.0F) {
  const GrayImage sheet = PadSheet();
  for (int row = 1; row < kCorners; ++row) {
    float in_row = 0.0F;
    for (int column = 1; column < kCorners; ++column) {
      const auto texel = static_cast<std::size_t>((row - 1) * kPadSheetTexels + column - 1);
      in_row += sheet.pixels[texel] == 0 ? 1.0F : 0.0F;
      const auto corner = static_cast<std::size_t>(row * kCorners + column);
      sums_[corner] = sums_[corner - kCorners] + in_row;
    }
  }
}

double SheetAverage::Integral(double column, double row) const {
  column = std::clamp(column, 0.0, static_cast<double>(kPadSheetTexels));
  row = std::clamp(row, 0.0, static_cast<double>(kPadSheetTexels));
  const int i = std::min(static_cast<int>(row), kPadSheetTexels - 1);
  const int j = std::min(static_cast<int>(column), kPadSheetTexels - 1);
  const double a = row - i;
  const double b = column - j;
  const float* const corner = &sums_[static_cast<std::size_t>(i * kCorners + j)];
  return (1.0 - a) * ((1.0 - b) * corner[0] + b * corner[1]) +
         a * ((1.0 - b) * corner[kCorners] + b * corner[kCorners + 1]);
}

double SheetAverage::Over(const Eigen::Vector2d& center_P, const Eigen::Vector2d& half_size) const {
  const double column = kTexelsPerMeter * (center_P.x() + 0.5 * kPadSheetSide);
  const double row = kTexelsPerMeter * (0.5 * kPadSheetSide - center_P.y());
  const double dx = kTexelsPerMeter * half_size.x();
  const double dy = kTexelsPerMeter * half_size.y();
  const double black = Integral(column + dx, row + dy) - Integral(column - dx, row + dy) -
                       Integral(column + dx, row - dy) + Integral(column - dx, row - dy);
  return 255.0 * (1.0 - black / (4.0 * dx * dy));
}

}  // namespace touchdown::estimation
